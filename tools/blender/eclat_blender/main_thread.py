"""Runs functions in Blender's main thread: operators need it, but renders of a window run in another thread."""
import threading

import bpy


def defer(function):
    """Runs a function in the main thread, between two events."""
    bpy.app.timers.register(function)


def call(function, is_cancelled=lambda: False):
    """Runs function() in the main thread and waits. Returns its result or raises its exception here; returns None if it was cancelled before it began."""
    if threading.current_thread() is threading.main_thread():
        return function()
    ended, began, outcome = threading.Event(), threading.Lock(), {}

    def run():
        if not began.acquire(blocking=False):
            return None
        try:
            outcome["result"] = function()
        except BaseException as why:  # raised again in the thread that waits
            outcome["why"] = why
        ended.set()
        return None
    defer(run)
    while not ended.wait(0.05):
        if is_cancelled() and began.acquire(blocking=False):
            return None
    if "why" in outcome:
        raise outcome["why"]
    return outcome["result"]

"""Waiting for an event: the one place where tests pause, between two looks at what they wait for. No verdict hangs on a clock: the guard only
ends what hangs."""
import os
import time

GUARD = 600  # seconds, also for processes that are waited for


def poll_until(happens, process=None, pause=0.01):
    """The last value of happens(): true; or what it is when the process that it is waited for from has ended."""
    end = time.monotonic() + GUARD
    while not (value := happens()):
        if process is not None and process.poll() is not None:
            return happens()
        assert time.monotonic() < end, f"waited for {GUARD} s in vain"
        time.sleep(pause)
    return value


def written(path):
    """Which writing of the file it is, since files that are replaced are others; None where there is none."""
    try:
        status = os.stat(path)
        return status.st_ino, status.st_mtime_ns
    except FileNotFoundError:
        return None


def poll_writes(path, process, count=1):
    """Until the process has written the file so many times more, or has ended."""
    seen, last = 0, written(path)

    def happens():
        nonlocal seen, last
        now = written(path)
        seen, last = seen + (now is not None and now != last), now
        return seen >= count
    return poll_until(happens, process)


def over_a_while(look, seconds):
    """look() before and after: for what must not change by itself."""
    before = look()
    time.sleep(seconds)
    return before, look()

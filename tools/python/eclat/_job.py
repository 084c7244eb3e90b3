"""Runs a job of the library in a separate thread, so that Ctrl-C and callbacks reach the thread that waits."""
from __future__ import annotations

import ctypes as c
import logging
import math
import queue
import sys
import threading
import warnings
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, Union

from . import _library as lib
from ._error import Warning, check
from ._library import library

log = logging.getLogger("eclat")
# Events of a job besides its messages: there may be new progress; the job has ended.
PROGRESS, END = object(), object()


class Progress(NamedTuple):
    """How far a job is."""
    fraction: float             # 0 to 1, towards the limit that will end it first
    seconds: float
    seconds_left: float | None  # None: not known
    samples: float              # per pixel
    error: float | None         # as of a picture; None: not known
    bound: float | None
    text: str                   # the same in words


Callback = Callable[[Progress], Any]
Shown = Union[bool, Callback, None]  # True: a bar


class PictureHandle:
    """A picture of the library. It is freed with the last reference to it."""

    def __init__(self, address: int) -> None:
        self.address = c.c_void_p(address)

    def __del__(self) -> None:
        library().eclat_picture_free(self.address)


class Result(NamedTuple):
    picture: PictureHandle | None
    reports: list[str]  # one, or one per frame
    says_no: bool


def frames_to_caller() -> int:
    """Returns the number of stack frames up to the first one outside the package, as warnings.warn counts them: that caller is warned."""
    frame, count = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        frame, count = frame.f_back, count + 1
    return count


def known(value: float) -> float | None:
    return value if math.isfinite(value) else None


class Job:
    def __init__(self, command: str, inputs: Iterable[str], options: Iterable[tuple[str, str | None]]) -> None:
        self.job, self.err = c.c_void_p(), lib.eclat_error()
        self.events: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self.reports: list[str] = []
        self.latest: Progress | None = None  # that the waiting thread has not seen yet
        self.code = lib.FAILED
        self.picture: PictureHandle | None = None
        check(library().eclat_job_new(command.encode(), self.job, self.err), self.err)
        for name in inputs:
            check(library().eclat_job_add(self.job, name.encode(errors="surrogateescape"), self.err), self.err)
        for option, value in options:
            text = None if value is None else value.encode(errors="surrogateescape")
            check(library().eclat_job_set(self.job, option.encode(), text, self.err), self.err)

    def __del__(self) -> None:
        library().eclat_job_free(self.job)

    def message(self, user: Any, severity: int, text: bytes) -> None:
        self.events.put((severity, text.decode(errors="replace")))

    def progress(self, user: Any, told: Any) -> int:
        """Keeps only the latest progress, for a slow reader."""
        p = told.contents
        self.latest = Progress(p.fraction, p.seconds, p.seconds_left if p.seconds_left >= 0 else None, p.samples_per_pixel,
                               known(p.error), known(p.error_bound), p.text.decode())
        self.events.put(PROGRESS)
        return 1

    def report(self, user: Any, text: Any, size: int) -> None:
        self.reports.append(c.string_at(text, size).decode(errors="replace"))

    def work(self, wants_picture: bool) -> None:
        """Runs in the thread of the job, and keeps the job alive if nobody waits for it any more."""
        picture = c.c_void_p()
        listener = lib.eclat_listener(message=lib.MESSAGE(self.message), progress=lib.PROGRESS(self.progress), report=lib.REPORT(self.report))
        library().eclat_job_listen(self.job, listener)
        self.code = library().eclat_job_run(self.job, picture if wants_picture else None, self.err)
        library().eclat_job_listen(self.job, None)
        self.picture = PictureHandle(picture.value) if picture.value else None
        self.events.put(END)

    def attend(self, callback: Callback | None) -> None:
        while (event := self.events.get()) is not END:
            if event is PROGRESS:
                progress, self.latest = self.latest, None
                if callback and progress and callback(progress) is False:
                    library().eclat_job_stop(self.job)
            elif event[0] == lib.WARNING:
                warnings.warn(event[1], Warning, stacklevel=frames_to_caller())
            else:
                log.log(logging.ERROR if event[0] == lib.FAILURE else logging.INFO, "%s", event[1])

    def run(self, wants_picture: bool = False, callback: Callback | None = None) -> Result:
        thread = threading.Thread(target=self.work, args=(wants_picture,), name="eclat", daemon=True)
        thread.start()
        try:
            self.attend(callback)
        except BaseException:  # Ctrl-C, or an exception from a callback or a warning
            library().eclat_job_stop(self.job)
            thread.join()  # waits for a wave of samples; a second Ctrl-C does not wait
            raise
        thread.join()
        check(self.code, self.err)
        return Result(self.picture, self.reports, bool(library().eclat_job_says_no(self.job)))


class Bar:
    """For progress=True: a bar by tqdm or, if that is not installed, a line on standard error."""

    def __init__(self) -> None:
        try:
            from tqdm.auto import tqdm  # type: ignore[import-untyped,unused-ignore]
            self.bar: Any = tqdm(total=100, bar_format="{bar:20} {desc}")
        except ImportError:
            self.bar = None

    def __call__(self, progress: Progress) -> None:
        if self.bar is None:
            print("\r" + progress.text, end="\x1b[K", file=sys.stderr, flush=True)
            return
        self.bar.n = round(100 * progress.fraction)
        self.bar.set_description_str(progress.text)

    def close(self, is_done: bool) -> None:
        if self.bar is None:
            print(file=sys.stderr)
            return
        self.bar.n = 100 if is_done else self.bar.n
        self.bar.close()


def run(command: str, inputs: Iterable[str], options: Iterable[tuple[str, str | None]], progress: Shown = None,
        wants_picture: bool = False) -> Result:
    job = Job(command, inputs, options)
    if progress is not True:
        return job.run(wants_picture, progress or None)
    bar, result = Bar(), None
    try:
        result = job.run(wants_picture, bar)
    finally:
        bar.close(result is not None)
    return result

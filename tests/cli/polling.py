"""Waits for events. This is the only module in which tests pause: between two looks at what they wait for. No verdict depends on a clock;
the time limit only ends a test that hangs."""
import os
import time

GUARD = 600  # seconds, also for processes that a test waits for


def poll_until(happens, process=None, pause=0.01):
    """Calls happens() until it returns something true, and returns that. If `process` ends first, returns a last happens()."""
    end = time.monotonic() + GUARD
    while not (value := happens()):
        if process is not None and process.poll() is not None:
            return happens()
        assert time.monotonic() < end, f"waited for {GUARD} s in vain"
        time.sleep(pause)
    return value


def written(path):
    """Identifies the last writing of a file: a file that is replaced gets another inode. None where there is no file."""
    try:
        status = os.stat(path)
        return status.st_ino, status.st_mtime_ns
    except FileNotFoundError:
        return None


def poll_writes(path, process, count=1):
    """Waits until the process has written the file `count` more times, or has ended."""
    seen, last = 0, written(path)

    def happens():
        nonlocal seen, last
        now = written(path)
        seen, last = seen + (now is not None and now != last), now
        return seen >= count
    return poll_until(happens, process)


def over_a_while(look, seconds):
    """Returns look() before and after a pause, to check that nothing changes by itself."""
    before = look()
    time.sleep(seconds)
    return before, look()

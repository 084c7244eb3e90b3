"""Binds libeclat.so by ctypes: the parts of eclat/eclat.h that the package uses, under their own names."""
from __future__ import annotations

import ctypes as c
from functools import cache
from pathlib import Path

from . import _drivers

LIBRARY = Path(__file__).with_name("libeclat.so.0")
OK, FAILED, USAGE = 0, 1, 2
STATUS, NOTE, WARNING, FAILURE = range(4)
ERROR_KINDS = ("other", "host memory", "device memory", "device")


class eclat_error(c.Structure):
    _fields_ = [("text", c.c_char * 2048), ("kind", c.c_int)]


class eclat_option(c.Structure):
    _fields_ = [("name", c.c_char_p), ("letter", c.c_char), ("takes_value", c.c_int), ("metavar", c.c_char_p), ("help", c.c_char_p),
                ("otherwise", c.c_char_p), ("choices", c.POINTER(c.c_char_p)), ("group", c.c_int), ("group_title", c.c_char_p),
                ("repeats", c.c_int), ("is_borrowed", c.c_int), ("refused", c.c_char_p)]


class eclat_progress(c.Structure):
    _fields_ = [("fraction", c.c_double), ("seconds", c.c_double), ("seconds_left", c.c_double), ("samples_per_pixel", c.c_double),
                ("error", c.c_double), ("error_bound", c.c_double), ("text", c.c_char_p)]


MESSAGE = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p)
PROGRESS = c.CFUNCTYPE(c.c_int, c.c_void_p, c.POINTER(eclat_progress))
REPORT = c.CFUNCTYPE(c.c_void_p, c.c_void_p, c.POINTER(c.c_char), c.c_size_t)


class eclat_listener(c.Structure):
    _fields_ = [("user", c.c_void_p), ("message", MESSAGE), ("progress", PROGRESS), ("report", REPORT), ("bold", c.c_int),
                ("begin", c.c_void_p), ("end", c.c_void_p), ("hint", c.c_void_p)]


class eclat_picture_error(c.Structure):
    _fields_ = [("error", c.c_double), ("error_bound", c.c_double), ("why", c.c_char_p), ("mean_luminance", c.c_double),
                ("samples_per_pixel", c.c_double), ("replicates", c.c_uint32)]


class eclat_stated_error(c.Structure):
    _fields_ = [("error", c.c_double), ("low95", c.c_double), ("high95", c.c_double)]


class eclat_denoised(c.Structure):
    _fields_ = [("denoised", eclat_stated_error), ("best", eclat_stated_error), ("bias", c.c_double), ("noise", c.c_double),
                ("tiles", c.c_uint32), ("tiles_nearer", c.c_uint32), ("tiles_off", c.c_uint32), ("why", c.c_char_p)]


class eclat_channel(c.Structure):
    _fields_ = [("name", c.c_char_p), ("data", c.c_void_p), ("stride", c.c_size_t)]


class eclat_attribute(c.Structure):
    _fields_ = [("name", c.c_char_p), ("text", c.c_char_p), ("number", c.c_double)]


_JOB, _PICTURE, _ERROR = c.c_void_p, c.c_void_p, c.POINTER(eclat_error)
_FUNCTIONS = {
    "eclat_option_at": (eclat_option, c.c_char_p, c.c_size_t),
    "eclat_job_new": (c.c_int, c.c_char_p, c.POINTER(_JOB), _ERROR),
    "eclat_job_free": (None, _JOB),
    "eclat_job_add": (c.c_int, _JOB, c.c_char_p, _ERROR),
    "eclat_job_set": (c.c_int, _JOB, c.c_char_p, c.c_char_p, _ERROR),
    "eclat_job_listen": (None, _JOB, c.POINTER(eclat_listener)),
    "eclat_job_stop": (None, _JOB),
    "eclat_job_run": (c.c_int, _JOB, c.POINTER(_PICTURE), _ERROR),
    "eclat_job_says_no": (c.c_int, _JOB),
    "eclat_picture_free": (None, _PICTURE),
    "eclat_picture_width": (c.c_uint32, _PICTURE),
    "eclat_picture_height": (c.c_uint32, _PICTURE),
    "eclat_picture_get_error": (eclat_picture_error, _PICTURE),
    "eclat_picture_get_denoised": (eclat_denoised, _PICTURE),
    "eclat_picture_channel_count": (c.c_size_t, _PICTURE),
    "eclat_picture_channel_at": (eclat_channel, _PICTURE, c.c_size_t),
    "eclat_picture_attribute_count": (c.c_size_t, _PICTURE),
    "eclat_picture_attribute_at": (eclat_attribute, _PICTURE, c.c_size_t),
    "eclat_picture_write": (c.c_int, _PICTURE, c.c_char_p, _ERROR),
}


@cache
def library() -> c.CDLL:
    """Returns the library. It is loaded at its first use, once the drivers are known."""
    _drivers.announce()
    loaded = c.CDLL(str(LIBRARY))
    for name, (result, *arguments) in _FUNCTIONS.items():
        function = getattr(loaded, name)
        function.restype, function.argtypes = result, arguments
    return loaded

"""What Windows refuses, in a process on another system; Python imports this at its start if its folder is on the path.

* To the packages of this project `sys.platform` is "win32" and `os.name` is "nt", modules that only POSIX has cannot be
  imported, and `os` and `signal` lack the names that only POSIX has.  All others need those, so they see the real ones.
* A text file that they open without an encoding is an error: that of Windows is not UTF-8.
* Below the folder FSCM_BENCH_WINDOWS no file gets a name that Windows reserves, forbids or shortens, or that differs
  from that of a neighbour in its capitals alone; no open file is replaced or removed, none by `rename` over another;
  there are no links.
"""

import builtins
import multiprocessing
import os
import re
import signal
import sys
import warnings
from errno import EACCES, EEXIST, EINVAL, EPERM
from multiprocessing import resource_tracker
from types import ModuleType

PACKAGES = {"comparisons", "fem_reference", "fscm", "fscm_bench"}

#: Modules of the standard library that Windows lacks, https://docs.python.org/3/library/ ("Availability: Unix").
MODULES = "crypt fcntl grp nis ossaudiodev posix pty pwd readline resource spwd syslog termios tty"

#: Names of `os` with the same availability, https://docs.python.org/3/library/os.html.
OS = """
O_ASYNC O_CLOEXEC O_DIRECT O_DIRECTORY O_DSYNC O_NDELAY O_NOATIME O_NOCTTY O_NOFOLLOW O_NONBLOCK O_PATH O_RSYNC O_SYNC
O_TMPFILE WNOHANG chown chroot confstr copy_file_range ctermid fchmod fchown fdatasync fork forkpty fpathconf fstatvfs
getegid geteuid getgid getgrouplist getgroups getloadavg getpgid getpgrp getpriority getresuid getuid initgroups killpg
lchmod lchown lockf major makedev memfd_create minor mkfifo mknod nice openpty pathconf pidfd_open pipe2 posix_fadvise
posix_fallocate posix_spawn pread preadv pwrite pwritev register_at_fork sched_getaffinity sched_setaffinity sched_yield
sendfile setegid seteuid setgid setgroups setpgid setpriority setsid setuid splice statvfs sync sysconf tcgetpgrp
tcsetpgrp ttyname uname wait wait3 wait4 waitid
"""

#: Names of `signal` in capitals that Windows has, https://docs.python.org/3/library/signal.html#signal.signal.
SIGNALS = "SIGABRT SIGFPE SIGILL SIGINT SIGSEGV SIGTERM SIGBREAK SIG_DFL SIG_IGN Signals Handlers"
#: Functions of `signal` that it lacks.
SIGNAL_FUNCTIONS = "alarm pause pthread_kill pthread_sigmask setitimer sigpending sigwait"


class Limited(ModuleType):
    """A module without some of its names, and with other values of some."""

    def __init__(self, module, lacks, other):
        super().__init__(module.__name__)
        object.__setattr__(self, "_of", (module, lacks, other))

    def __getattribute__(self, name):
        module, lacks, other = object.__getattribute__(self, "_of")
        if name in lacks:
            raise AttributeError(f"module {module.__name__!r} has no attribute {name!r} on Windows")
        return other[name] if name in other else getattr(module, name)

    def __setattr__(self, name, value):
        setattr(object.__getattribute__(self, "_of")[0], name, value)


LACKING_SIGNALS = {name for name in dir(signal) if name != name.lower()} - set(SIGNALS.split())
LIMITED = {
    "os": Limited(os, set(OS.split()), {"name": "nt"}),
    "sys": Limited(sys, {"getdlopenflags", "setdlopenflags"}, {"platform": "win32"}),
    "signal": Limited(signal, LACKING_SIGNALS | set(SIGNAL_FUNCTIONS.split()), {}),
    # It passes descriptors to a process, which `_posixsubprocess` does.
    "multiprocessing": Limited(
        multiprocessing, (), {"resource_tracker": Limited(resource_tracker, {"ensure_running"}, {})}
    ),
}
import_of_python = builtins.__import__


def import_on_windows(name, globals=None, locals=None, fromlist=(), level=0):
    """Import as `builtins.__import__`; to a module of this project as on Windows."""
    importer = (globals or {}).get("__name__", "").partition(".")[0]
    if importer in PACKAGES and not level:
        if name in MODULES.split():
            raise ModuleNotFoundError(f"No module named {name!r} on Windows", name=name)
        if name.partition(".")[0] in LIMITED:
            module = import_of_python(name, globals, locals, fromlist, level)
            return LIMITED.get(module.__name__, module)
    return import_of_python(name, globals, locals, fromlist, level)


builtins.__import__ = import_on_windows

# `subprocess` warns in its own name.
warnings.simplefilter("ignore", EncodingWarning)
warnings.filterwarnings("error", category=EncodingWarning, module=rf"({'|'.join([*PACKAGES, 'subprocess'])})(\.|$)")

FOLDER = os.path.realpath(os.environ["FSCM_BENCH_WINDOWS"]) + os.sep

#: https://learn.microsoft.com/windows/win32/fileio/naming-a-file
RESERVED = re.compile(r"(?i)(con|prn|aux|nul|com[0-9¹²³]|lpt[0-9¹²³])(\..*)?")
FORBIDDEN = re.compile(r'[<>:"|?*\\\x00-\x1f]|[. ]$')
WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def refuse_name(path):
    """Refuse a name of a new file or folder."""
    folder, name = os.path.split(path)
    if RESERVED.fullmatch(name) or FORBIDDEN.search(name):
        raise OSError(EINVAL, "Windows has no such name", path)
    if not os.path.lexists(path):
        alike = [other for other in os.listdir(folder) if other.lower() == name.lower()]
        if alike:
            raise OSError(EEXIST, f"to Windows this is {alike[0]}", path)


def refuse_open(path):
    """Refuse to remove or replace what this process has open."""
    for descriptor in os.listdir("/proc/self/fd"):
        try:
            if os.readlink(f"/proc/self/fd/{descriptor}") == path:
                raise PermissionError(EACCES, "to Windows this file is in use", path)
        except FileNotFoundError:
            continue


def as_windows(event, arguments):
    """Raise the error of Windows for what Python is about to do with a file below the folder."""
    if event == "sqlite3.connect":
        changed = [arguments[0]]
    elif event in ("open", "os.mkdir", "os.remove", "os.rmdir"):
        changed = [arguments[0]] if event != "open" or arguments[2] & WRITES else []
    elif event in ("os.rename", "os.link", "os.symlink"):
        changed = list(arguments[:2])
    else:
        return
    changed = [os.fsdecode(path) for path in changed if isinstance(path, (str, bytes, os.PathLike))]
    changed = [os.path.join(os.path.realpath(os.path.dirname(path)), os.path.basename(path)) for path in changed]
    if not changed or not changed[-1].startswith(FOLDER):
        return
    if event in ("os.link", "os.symlink"):
        raise OSError(EPERM, "a user of Windows may make no links", changed[0])
    if event in ("os.remove", "os.rename"):
        for path in changed:
            refuse_open(path)
    # A temporary file without a name is opened by its folder.
    if event in ("open", "os.mkdir", "sqlite3.connect", "os.rename") and not os.path.isdir(changed[-1]):
        refuse_name(changed[-1])


sys.addaudithook(as_windows)

"""The programs that run, and the signals that end them."""

from __future__ import annotations

import signal
import subprocess
import threading
from types import FrameType
from typing import Any


class Children:
    """The programs that run, so that an interrupt can end them."""

    def __init__(self) -> None:
        # A signal handler takes the lock too, in the middle of `end`: it must not wait for itself.
        self.lock = threading.RLock()
        self.running: set[subprocess.Popen[str]] = set()
        self.ended = False

    def run(self, command: list[str]) -> tuple[int, str, str]:
        """Runs a program; returns its exit code, output and errors. The code is 130 if `end` stopped it."""
        with self.lock:
            if self.ended:
                return 130, "", "interrupted"
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.running.add(child)
        try:
            while True:
                # Ray cancels a task with an exception that does not interrupt a wait without a limit.
                try:
                    output, errors = child.communicate(timeout=0.5)
                    break
                except subprocess.TimeoutExpired:
                    continue
        except BaseException:
            child.terminate()
            child.wait()
            raise
        finally:
            with self.lock:
                self.running.discard(child)
        # A program that has not installed its handlers yet is ended by the signal itself.
        return 130 if self.ended and child.returncode else child.returncode, output, errors

    def end(self) -> None:
        """Stops all programs, which remove their unfinished files, and starts no more. A second call stops them immediately."""
        with self.lock:
            self.ended = True
            for child in self.running:
                child.terminate()


CHILDREN = Children()
SIGNALS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


def end_on_signals(before: dict[signal.Signals, Any]) -> None:
    """Lets interrupts stop the programs. `before` holds the earlier handlers; a signal that they ignore stays ignored."""

    def stop(number: int, frame: FrameType | None) -> None:
        CHILDREN.end()

    for number, handler in before.items():
        if handler != signal.SIG_IGN:
            signal.signal(number, stop)

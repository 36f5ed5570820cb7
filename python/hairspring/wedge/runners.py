"""Where variants run: on this machine, or on a Ray cluster."""

from __future__ import annotations

import re
import signal
import socket
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from typing import Any

from .programs import CHILDREN, end_on_signals
from .task import run_variant

Report = Callable[[dict, dict], None]
"""Receives a task and its result."""


class UnavailableError(Exception):
    """The machine lacks what the command needs: one sentence."""


def run_here(all_tasks: list[dict], jobs: int, retries: int, report: Report) -> None:
    """Runs tasks on this machine."""

    def attempt(task: dict) -> dict:
        for _ in range(retries + 1):
            result = run_variant(task)
            # A scene that is wrong stays wrong.
            if "error" not in result or result.get("code") in (2, 3, 4, 6, 130):
                break
        return result

    with ThreadPoolExecutor(max_workers=jobs) as pool:
        waiting = {pool.submit(attempt, task): task for task in all_tasks}
        for future in as_completed(waiting):
            result = future.result()
            if not (CHILDREN.ended and result.get("code") == 130):
                report(waiting[future], result)


def run_on_worker(task: dict) -> dict:
    """As `run_variant`, in a process of Ray. The cancellation of a task arrives as an interrupt, which must not be ignored."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.default_int_handler)
    return run_variant(task)


def check_answers(address: str) -> None:
    """Refuses an address of a cluster at which nothing listens. Ray itself would wait for a minute and end the process."""
    found = re.fullmatch(r"(?:ray://)?(.+):([0-9]{1,5})", address)
    if not found:
        return
    try:
        socket.create_connection((found[1].strip("[]"), int(found[2])), timeout=10).close()
    except (OSError, OverflowError) as error:
        reason = getattr(error, "strerror", None) or error
        raise UnavailableError(
            f"--ray {address}: nothing answers there ({reason}); start the cluster with `ray start --head`, or use `--ray local`"
        ) from None


def run_on_ray(all_tasks: list[dict], address: str, retries: int, report: Report, signals: dict[signal.Signals, Any]) -> None:
    """Runs tasks on a Ray cluster, which retries those whose worker is lost. `signals` are as for `end_on_signals`."""
    try:
        import ray
    except ImportError:
        raise UnavailableError("ray is not installed; run `pip install 'hairspring[ray]'`") from None
    check_answers(address)
    try:
        ray.init(address=address, log_to_driver=False, include_dashboard=False)
    except (ConnectionError, RuntimeError, ValueError) as error:
        sentence = (str(error).splitlines() or ["no answer"])[0]
        raise UnavailableError(f"--ray {address}: the cluster cannot be used: {sentence}") from None
    remote = ray.remote(max_retries=retries, retry_exceptions=True)(run_on_worker)
    # Ray has replaced the handlers.
    end_on_signals(signals)
    waiting = {remote.remote(task): task for task in all_tasks}
    while waiting and not CHILDREN.ended:
        for ready in ray.wait(list(waiting), num_returns=1, timeout=0.5)[0]:
            try:
                result = ray.get(ready)
            except ray.exceptions.RayError as error:
                result = {"error": f"the task was lost on the cluster: {str(error).splitlines()[0]}", "code": 1}
            report(waiting.pop(ready), result)
    # The tasks end their programs and wait for them. Ray itself would kill the programs, and their unfinished files would stay.
    for unfinished in waiting:
        ray.cancel(unfinished)
    if waiting:
        ray.wait(list(waiting), num_returns=len(waiting), timeout=60)
    ray.shutdown()

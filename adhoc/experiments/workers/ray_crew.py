"""Workers that are tasks of a Ray cluster (extra `adhoc[ray]`)."""

from __future__ import annotations

import logging
import os
import pickle
import secrets
import socket
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing import AuthenticationError
from multiprocessing.connection import Client, Connection, Listener
from typing import Any

from adhoc.core.errors import ConfigurationError, MissingDependency
from adhoc.experiments.comparison import MakeComparisons
from adhoc.experiments.workers.line import Line
from adhoc.experiments.workers.wire import Wire
from adhoc.experiments.workers.worker import serve

_RESULT_S = 2.0
"""Seconds after a worker hung up within which an error of its own is known; later it counts as killed."""
_ANSWER_S = 5.0
"""Seconds within which a cluster must answer."""


class RayWorker:
    """A `Worker` that is a task of a cluster; it calls back over TCP when it begins."""

    def __init__(self, ray: Any, number: int, task: Any) -> None:
        self.number = number
        self.wire: Wire | None = None
        self._ray, self._task = ray, task
        self._death = "it is gone, or its node is"

    def has_ended(self) -> bool:
        """See `Worker`."""
        return bool(self._ray.wait([self._task], timeout=0)[0])

    def is_killed(self) -> bool:
        """See `Worker`. A node that is lost takes Ray longer to notice than its workers' hanging up."""
        try:
            self._ray.get(self._task, timeout=_RESULT_S)
        except self._ray.exceptions.RayTaskError as error:
            self._death = f"an error on its node: {error}"
            return False
        except self._ray.exceptions.RayError as error:
            self._death = type(error).__name__
            return True
        self._death = "its work done"
        return False

    @property
    def death(self) -> str:
        """See `Worker`."""
        return self._death

    def stop(self) -> None:
        """See `Worker`."""
        with suppress(self._ray.exceptions.RayError):
            self._ray.cancel(self._task, force=True)
        if self.wire is not None:
            self.wire.close()


class RayCrew:
    """Hires workers in a cluster and takes their calls.

    Args:
        ray: The package, connected to a cluster.
        make: What workers run, see `MakeComparisons`. The library must be installed on all nodes.
        cpus: Of the cluster, for each worker.
    """

    def __init__(self, ray: Any, make: MakeComparisons, cpus: float) -> None:
        self._ray, self._make, self._cpus = ray, make, cpus
        self._secret = secrets.token_bytes(32)
        self._listener = Listener((ray.util.get_node_ip_address(), 0), authkey=self._secret)
        self._hired: dict[int, RayWorker] = {}
        self._closed = False
        self._answering = threading.Thread(target=self._take_calls, name="calls-of-workers", daemon=True)
        self._answering.start()

    def hire(self, number: int) -> RayWorker:
        """Start the worker of that number as soon as the cluster has room for it."""
        remote = self._ray.remote(num_cpus=self._cpus, max_retries=0)(_work_remotely)
        make = pickle.dumps(self._make)  # unpacked when the node knows where modules are
        task = remote.remote(self._listener.address, self._secret, number, make, sys.path, os.getcwd())
        self._hired[number] = RayWorker(self._ray, number, task)
        return self._hired[number]

    def close(self) -> None:
        """Take no more calls, and let go of what belongs to the cluster."""
        self._closed = True
        with suppress(OSError):
            # Closing the listener does not wake who waits at it; somebody who calls and says nothing does.
            socket.create_connection(self._listener.address, _ANSWER_S).close()
        self._answering.join(_ANSWER_S)
        self._listener.close()
        self._hired.clear()

    def _take_calls(self) -> None:
        while not self._closed:
            try:
                connection = self._listener.accept()
                number = connection.recv()
            except (AuthenticationError, EOFError, OSError):
                continue  # not one of ours, or it died at once, or the crew is closed
            worker = self._hired.get(number)
            if worker is not None:
                worker.wire = Wire(connection)


@contextmanager
def ray_crew(make: MakeComparisons, address: str | None = None, cpus: float = 1.0) -> Iterator[RayCrew]:
    """A crew in a cluster. If this process is connected to one already, that is used and left connected.

    Args:
        make: See `RayCrew`.
        address: Of a running cluster, such as `auto`; None starts one on this machine.
        cpus: See `RayCrew`.

    Raises:
        MissingDependency: Ray is not installed.
        ConfigurationError: There is no cluster at that address, or `cpus` is not positive.
    """
    if cpus <= 0:
        raise ConfigurationError(f"executor.cpus={cpus}: must be positive")
    ray = _load_ray()
    is_ours = not ray.is_initialized()
    if is_ours:
        _check_address(address)
        try:
            # Of None it would make any cluster that somebody else has begun on this machine.
            ray.init(address=address or "local", include_dashboard=False, logging_level=logging.WARNING)
        except (ConnectionError, RuntimeError, ValueError) as error:
            raise ConfigurationError(f"executor.address={address}: {error}") from error
    crew = RayCrew(ray, make, cpus)
    try:
        yield crew
    finally:
        crew.close()
        if is_ours:
            ray.shutdown()


def _work_remotely(
    address: Any, secret: bytes, number: int, make: bytes, paths: Sequence[str], folder: str
) -> None:
    """The task: call the parent, and work. Modules and files beside the parent are found where the node has
    the same folders."""
    sys.path.extend(path for path in paths if path not in sys.path)
    with suppress(OSError):
        os.chdir(folder)
    connection: Connection = Client(address, authkey=secret)
    connection.send(number)
    line = Line(connection)
    try:
        serve(line, pickle.loads(make))
    finally:
        line.hang_up()  # the process lives on, for other tasks


def _check_address(address: str | None) -> None:
    """Ray itself tries for minutes to reach a cluster that is not there."""
    host, colon, port = (address or "").rpartition(":")
    if not (colon and port.isdecimal()) or "://" in host:
        return
    try:
        socket.create_connection((host, int(port)), _ANSWER_S).close()
    except (OSError, OverflowError) as error:
        raise ConfigurationError(f"executor.address={address}: no cluster answers there ({error})") from error


def _load_ray() -> Any:
    try:
        import ray
    except ImportError as error:
        raise MissingDependency("executor=ray needs Ray: pip install 'adhoc[ray]'") from error
    return ray

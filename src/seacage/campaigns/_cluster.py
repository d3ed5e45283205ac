"""A Dask cluster in the place of the pool of processes."""

# distributed leaves its signatures untyped.
# pyright: reportUnknownMemberType=false

import asyncio
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import CancelledError, ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

from seacage.conventions import SeacageError

if TYPE_CHECKING:
    from distributed import Client

# How long a scheduler may take to answer, and how long it may be without a worker [s]
_CONNECT_S, _WORKER_S = 10.0, 60.0

Task = TypeVar("Task")
Answer = TypeVar("Answer")


def map_on_cluster(
    work: Callable[[Task], Answer], tasks: Sequence[Task], *, address: str
) -> Generator[tuple[Task, Answer], None, None]:
    """Tasks with their answers, in the order in which the cluster's workers end them.

    A task whose worker is lost goes to another. Closing the iterator drops what has not ended.

    ``work``: a function of a module that the workers have installed, too. ``tasks``: what to do.
    ``address``: of the scheduler, ``tcp://host:8786``. Tasks and answers travel as pickles: name
    only a cluster that you trust.

    Raises SeacageError: no scheduler answers, it has no worker, or it was lost on the way.
    """
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    with _connect(address) as client:
        futures = [client.submit(work, task, pure=False) for task in tasks]
        task_of = {future.key: task for future, task in zip(futures, tasks, strict=True)}
        futures_left = as_completed(futures, loop=client.loop)
        del futures  # an answer that was taken need not stay in the cluster
        try:
            for future in futures_left:
                yield task_of[future.key], future.result()
        except KilledWorker as error:
            raise SeacageError(
                f"{address}: several workers ended with the same block of cases, perhaps for "
                "want of memory. Give them more, or fewer threads each, and run again; what is "
                "done is kept."
            ) from error
        except CancelledError as error:
            raise SeacageError(
                f"{address}: the scheduler was lost. Start it and run again; what is done is kept."
            ) from error


def _connect(address: str) -> "Client":
    from distributed import Client

    try:
        with ThreadPoolExecutor(1) as aside:  # a notebook's thread has a loop that is running
            aside.submit(asyncio.run, _greet(address)).result()
    except (OSError, ValueError) as error:
        raise SeacageError(
            f"{address}: no Dask scheduler answers ({error}). Start one with `dask scheduler`, and "
            "workers with `dask worker ADDRESS`; its address looks like tcp://host:8786."
        ) from error
    client = Client(address, timeout=_CONNECT_S, set_as_default=False)
    try:
        client.wait_for_workers(1, timeout=_WORKER_S)
    except TimeoutError as error:
        client.close()
        raise SeacageError(
            f"{address}: the scheduler has had no worker for {_WORKER_S:g} s. "
            f"Start some with `dask worker {address}`."
        ) from error
    return client


async def _greet(address: str) -> None:
    """Connect once and leave: a client that cannot connect would go on trying for long."""
    from distributed.comm.core import connect

    comm = await connect(address, timeout=_CONNECT_S)
    await comm.close()

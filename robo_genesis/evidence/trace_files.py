"""Write traces and joints to npz files and `arrays.json`, and read them back.

The names of stored arrays end with their unit. A bundle holds runs of joints, or, if it
has no joints, of free bodies.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar
from zipfile import BadZipFile

import numpy as np

from robo_genesis.core.trace import (
    BodyTrace,
    ContactTrace,
    Demonstrations,
    Episodes,
    TimeSeries,
    Trace,
    TraceError,
)
from robo_genesis.sim.arm.joints import JointMap

from .bundle import (
    ARRAYS,
    Arrays,
    CaseArrays,
    JointRecord,
    Variable,
    write_json,
)
from .refusals import AGAIN, BundleRefused, expect_equal

Kind = TypeVar("Kind", bound=TimeSeries)


def dof_units(name: str, joints: JointMap | None) -> list[str]:
    """Return the unit of each DOF in one array, by its name; none for free bodies."""
    if joints is None:
        return []
    if "qd" in name:
        return [f"{unit}/s" for unit in joints.position_units]
    is_position = name.startswith(("q_", "target"))
    return [*(joints.position_units if is_position else joints.effort_units)]


def write_traces(
    folder: Path,
    traces: Mapping[str, TimeSeries],
    joints: JointMap | None,
    links: Sequence[str],
    notes: Mapping[str, str] = MappingProxyType({}),
) -> Arrays:
    """Write `arrays/<case>.npz` for every trace, and `arrays.json`; see `describe`."""
    (folder / "arrays").mkdir()
    described = describe(traces, joints, links, notes)
    for case, trace in traces.items():
        named = {
            stored.name: getattr(trace, field)
            for field, stored in trace.arrays().items()
        }
        np.savez(folder / described.cases[case].file, allow_pickle=False, **named)
    write_json(folder / ARRAYS, described.model_dump(by_alias=True))
    return described


def describe(
    traces: Mapping[str, TimeSeries],
    joints: JointMap | None,
    links: Sequence[str],
    notes: Mapping[str, str],
) -> Arrays:
    """Return the content of `arrays.json`.

    Args:
        traces: by case.
        joints: of the DOFs, None for free bodies.
        links: the labels of the axis of links.
        notes: by case, how its arrays differ from their long names; most cases need
            none.

    Raises:
        TraceError: an array has another number of DOFs or links than there are labels.
    """
    coords = {"link": list(links)} | ({"dof": list(joints.names)} if joints else {})
    cases = {}
    for case, trace in traces.items():
        variables = {}
        for field, stored in trace.arrays().items():
            array = getattr(trace, field)
            variables[stored.name] = Variable(
                dims=list(stored.dims),
                shape=list(array.shape),
                dtype=str(array.dtype),
                unit=stored.unit or dof_units(stored.name, joints),
                long_name=stored.long_name,
            )
            for dim, count in zip(stored.dims, array.shape, strict=True):
                if len(coords.get(dim, range(count))) != count:
                    raise TraceError(
                        f"{case}: {stored.name} has {count} of {dim}, expected "
                        f"{', '.join(coords[dim])}."
                    )
        note = notes.get(case, "")
        file = f"arrays/{case}.npz"
        cases[case] = CaseArrays(file=file, note=note, variables=variables)
    records = joint_records(joints) if joints else []
    return Arrays(coords=coords, joints=records, cases=cases)


def joint_records(joints: JointMap) -> list[JointRecord]:
    """Return a record of each joint, in the order of the map."""
    return [
        JointRecord.model_validate(
            {
                "name": name,
                "type": joints.types[k],
                "dof_idx_local": int(joints.dofs_idx_local[k]),
                "q_idx_local": int(joints.qs_idx_local[k]),
                "lower": _finite(joints.lower[k]),
                "upper": _finite(joints.upper[k]),
                "unit": joints.position_units[k],
            }
        )
        for k, name in enumerate(joints.names)
    ]


def _finite(limit: float) -> float | None:
    """Return a limit as JSON can hold it, None if the model has none."""
    return None if np.isinf(limit) else float(limit)


def read_joints(arrays: Arrays) -> JointMap:
    """Return the recorded joint map."""
    joints = arrays.joints
    return JointMap(
        names=tuple(joint.name for joint in joints),
        types=tuple(joint.type_ for joint in joints),
        dofs_idx_local=np.array([joint.dof_idx_local for joint in joints]),
        qs_idx_local=np.array([joint.q_idx_local for joint in joints]),
        lower=np.array([-np.inf if j.lower is None else j.lower for j in joints]),
        upper=np.array([np.inf if j.upper is None else j.upper for j in joints]),
    )


def read_any_trace(folder: Path, arrays: Arrays, case: str) -> Any:
    """Return one run of the kind whose arrays a bundle describes; see `read_run`."""
    names = {*arrays.cases[case].variables}
    kinds = (Demonstrations, Episodes, Trace, ContactTrace, BodyTrace)
    fitting = (
        kind
        for kind in kinds
        if {stored.name for stored in kind.arrays().values()} <= names
    )
    return read_run(folder, case, next(fitting, Trace))


def read_run(folder: Path, case: str, kind: type[Kind]) -> Kind:
    """Return one run.

    Args:
        folder: of the bundle.
        case: the name of the run.
        kind: a class of `core/trace.py`.

    Raises:
        BundleRefused: `bad-array` if the archive cannot be read, or has other arrays;
            `bad-trace` if they do not form one run.
    """
    file = f"arrays/{case}.npz"
    try:
        with np.load(folder / file, allow_pickle=False) as archive:
            arrays = dict(archive)
    except (OSError, ValueError, BadZipFile) as error:
        message = f"{file}: {error}, expected an archive of arrays of numbers. {AGAIN}"
        raise BundleRefused("bad-array", message) from error
    found = {name: str(array.dtype) for name, array in arrays.items()}
    expected = {stored.name: stored.dtype for stored in kind.arrays().values()}
    expect_equal("bad-array", file, "type of {}", found, expected)
    try:
        return kind(
            **{field: arrays[stored.name] for field, stored in kind.arrays().items()}
        )
    except TraceError as error:
        raise BundleRefused("bad-trace", f"{file}: {error} {AGAIN}") from error

"""Write traces and joints to npz files and `arrays.json`, and read them back.

The names of stored arrays end with their unit. A bundle holds runs of joints, or, if it
has no joints, of free bodies.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

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
from robo_genesis.evidence.bundle import Arrays, CaseArrays, JointRecord, Variable
from robo_genesis.evidence.npz_archive import read_archive, write_archive
from robo_genesis.evidence.refusals import AGAIN, BundleRefused, expect, expect_equal
from robo_genesis.sim.arm.joints import EFFORT_UNIT, POSITION_UNIT, JointMap

Kind = TypeVar("Kind", bound=TimeSeries)


def dof_units(name: str, types: Sequence[str]) -> list[str]:
    """Return the unit of each DOF in one array, by its name, from the types of the joints."""
    positions = [POSITION_UNIT[kind] for kind in types]
    if name.startswith(("q_", "target")):
        return positions
    if "qd" in name:
        return [f"{unit}/s" for unit in positions]
    return [EFFORT_UNIT[kind] for kind in types]


def write_traces(
    folder: Path,
    traces: Mapping[str, TimeSeries],
    joints: JointMap | None,
    links: list[str],
    notes: Mapping[str, str] | None = None,
) -> Arrays:
    """Write `arrays/<case>.npz` for every trace and return the content of `arrays.json`.

    Args:
        folder: of the bundle.
        traces: by case.
        joints: of the DOFs, None for free bodies.
        links: the labels of the axis of links.
        notes: by case, how its arrays differ from their long names; most cases need
            none.
    """
    (folder / "arrays").mkdir()
    types, cases = joints.types if joints else (), {}
    for case, trace in traces.items():
        cases[case] = described = _description(
            case, trace, types, (notes or {}).get(case, "")
        )
        values = {
            of.name: getattr(trace, field) for field, of in trace.arrays().items()
        }
        write_archive(folder / described.file, values)
    coords = {"dof": list(joints.names)} if joints else {}
    records = joint_records(joints) if joints else []
    return Arrays(coords=coords | {"link": links}, joints=records, cases=cases)


def _description(
    case: str, trace: TimeSeries, types: Sequence[str], note: str
) -> CaseArrays:
    """Return the entry of `arrays.json` of one run, whose joints have these types."""
    variables = {}
    for field, of in trace.arrays().items():
        array = getattr(trace, field)
        variables[of.name] = Variable(
            dims=list(of.dims),
            shape=list(array.shape),
            dtype=str(array.dtype),
            unit=dof_units(of.name, types) if of.unit is None else of.unit,
            long_name=of.long_name,
        )
    return CaseArrays(file=f"arrays/{case}.npz", note=note, variables=variables)


def joint_records(joints: JointMap) -> list[JointRecord]:
    """Return a record of each joint, in the order of the map.

    Raises:
        ValueError: a limit is not a number.
    """
    return [
        JointRecord(
            name=name,
            type=joints.types[k],
            dof_idx_local=int(joints.dofs_idx_local[k]),
            q_idx_local=int(joints.qs_idx_local[k]),
            lower=None if joints.lower[k] == -np.inf else float(joints.lower[k]),
            upper=None if joints.upper[k] == np.inf else float(joints.upper[k]),
            unit=joints.position_units[k],
        )
        for k, name in enumerate(joints.names)
    ]


def read_joints(arrays: Arrays) -> JointMap:
    """Return the recorded joint map after comparing it with the labels of the arrays.

    Raises:
        BundleRefused: `labels` if names, types or units contradict each other.
    """
    joints, file = arrays.joints, "arrays.json joints"
    expect(
        "labels",
        file,
        "list of names",
        [j.name for j in joints],
        arrays.coords.get("dof", []),
    )
    for joint in joints:
        unit = POSITION_UNIT.get(joint.type_, "that of another type")
        expect(
            "labels", file, f"unit of {joint.name}, {joint.type_},", joint.unit, unit
        )
    return JointMap(
        names=tuple(joint.name for joint in joints),
        types=tuple(joint.type_ for joint in joints),
        dofs_idx_local=np.array([joint.dof_idx_local for joint in joints]),
        qs_idx_local=np.array([joint.q_idx_local for joint in joints]),
        lower=np.array([-np.inf if j.lower is None else j.lower for j in joints]),
        upper=np.array([np.inf if j.upper is None else j.upper for j in joints]),
    )


def read_any_trace(folder: Path, arrays: Arrays, case: str) -> Any:
    """Return one run of the kind that a bundle describes; see `read_run`.

    Verification does not use it, because a bundle must not choose the kind of its own
    runs.
    """
    names = {*arrays.cases[case].variables}
    kinds = (Demonstrations, Episodes, Trace, ContactTrace, BodyTrace)
    kind = next(
        (of for of in kinds if {one.name for one in of.arrays().values()} <= names),
        Trace,
    )
    return read_run(folder, arrays, case, kind)


def read_run(folder: Path, arrays: Arrays, case: str, kind: type[Kind]) -> Kind:
    """Return one run of a kind; `arrays.json` must be the description that `write_traces` gives.

    Args:
        folder: of the bundle.
        arrays: its description.
        case: the name of the run.
        kind: a class of `core/trace.py`.

    Raises:
        BundleRefused: `labels`, `path`, `too-big` or `bad-array`; `bad-trace` if the
            arrays do not form one run.
    """
    described, fields, place = arrays.cases[case], kind.arrays(), f"arrays.json {case}"
    expect("path", place, "file", described.file, f"arrays/{case}.npz")
    types = read_joints(arrays).types if arrays.joints else ()
    dtypes = {of.name: of.dtype for of in fields.values()}
    expect(
        "labels", place, "list of arrays", sorted(described.variables), sorted(dtypes)
    )
    values = read_archive(folder / described.file, described.file, dtypes)
    try:
        trace = kind(**{field: values[of.name] for field, of in fields.items()})
    except TraceError as error:
        raise BundleRefused(
            "bad-trace", f"{described.file}: {error} {AGAIN}"
        ) from error
    expected = _description(case, trace, types, described.note)
    axes = [zip(of.dims, of.shape, strict=True) for of in expected.variables.values()]
    lengths = {dim: n for pairs in axes for dim, n in pairs if dim in ("dof", "link")}
    labels = {
        axis: len(names) for axis, names in arrays.coords.items() if axis in lengths
    }
    expect("labels", place, "number of labels", labels, lengths)
    expect_equal("labels", place, "{}", described.model_dump(), expected.model_dump())
    return trace

"""Runs of free bodies as channels: where a link's origin is along an axis, and how fast it goes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from robo_genesis.core.channels import Channel, Runs, View
from robo_genesis.core.text import listed, said, time_digits
from robo_genesis.core.trace import BodyTrace


@dataclass(frozen=True, slots=True)
class Direction:
    """An axis of the world in words: of a position and a velocity along it, and both ways."""

    entry: int
    position: str
    velocity: str
    heads: tuple[str, str]
    at: str
    on: str
    back: str


AXES = {
    "x": Direction(0, "x", "velocity along x", ("x", "ẋ"), "x =", "moved on by", "moved back by"),
    "y": Direction(1, "y", "velocity along y", ("y", "ẏ"), "y =", "moved on by", "moved back by"),
    "z": Direction(
        2, "height", "vertical velocity", ("z", "ż"), "a height of", "rose by", "fell by"
    ),
}


def runs(
    traces: Mapping[str, BodyTrace],
    links: Sequence[str],
    link: str,
    thing: str,
    axes: Sequence[str] = ("z",),
) -> Runs:
    """Return the runs of free bodies with all that is said of them.

    Args:
        traces: by case.
        links: names, in the order of the traces' arrays.
        link: the one that the curves follow.
        thing: what a reader sees move: "box".
        axes: of the world, each a key of `AXES`.

    Raises:
        ValueError: the runs have no such link, or there is no such axis; as `Runs`.
    """
    for name, valid in ((link, links), *((axis, tuple(AXES)) for axis in axes)):
        if name not in valid:
            raise ValueError(
                f"{name!r} cannot be followed. Available: {', '.join(valid)}. Correct the lesson's "
                "`Moving` declaration."
            )
    subject = f"the {thing}"
    followed = channels(traces, links.index(link), axes)
    first, cases = followed[0].name.capitalize(), listed(list(traces))
    return Runs(
        subject=subject,
        traces=traces,
        links=links,
        channels=followed,
        levels=(),
        moves=moves(traces, links, links.index(link), thing, axes),
        view=View(
            thing=thing,
            alt=f"{subject.capitalize()} in 3D, where it is at the sample that is shown.",
            orbit="30deg 72deg auto",
        ),
        alt=f"{first} of {subject} over time{f': {cases}' if len(traces) > 1 else ''}.",
        caption=f"{first} of {subject}, from get_links_pos.",
    )


def channels(traces: Mapping[str, BodyTrace], link: int, axes: Sequence[str]) -> list[Channel]:
    """Return position and velocity of the origin of a link along each axis."""
    found = []
    for axis in (AXES[name] for name in axes):
        where = {case: trace.link_pos[:, link, axis.entry] for case, trace in traces.items()}
        speed = {case: trace.link_vel[:, link, axis.entry] for case, trace in traces.items()}
        found += [
            Channel(axis.position, axis.heads[0], "m", 4, where),
            Channel(axis.velocity, axis.heads[1], "m/s", 4, speed),
        ]
    return found


def moves(
    traces: Mapping[str, BodyTrace],
    links: Sequence[str],
    link: int,
    thing: str,
    axes: Sequence[str],
) -> dict[str, str]:
    """Say for each case, as Markdown, what a viewer would see move: along each axis, and at all."""
    words = {}
    for case, trace in traces.items():
        far = np.linalg.norm(trace.link_pos - trace.link_pos[0], axis=2).max(axis=0)
        along = "; it ".join(along_axis(trace, link, AXES[name]) for name in axes)
        words[case] = f"**{case}**: the {thing} {along}."
        if len(links) > 1:
            words[case] += (
                f" The link `{links[far.argmax()]}` moves farthest, by up to "
                f"{100 * far.max():.1f} cm."
            )
    return words


def along_axis(trace: BodyTrace, link: int, axis: Direction) -> str:
    """Say where the origin of a link starts and ends along one axis, and when it is fastest."""
    path, velocity = (array[:, link, axis.entry] for array in (trace.link_pos, trace.link_vel))
    by, k = float(path[-1] - path[0]), int(np.abs(velocity).argmax())
    there = f"starts at {axis.at} {said(path[0], 'm')} and ends at {axis.at} {said(path[-1], 'm')}"
    if float(f"{by:.4f}") != 0:
        there += f": it {axis.on if by > 0 else axis.back} {said(abs(by), 'm')}"
    if float(f"{velocity[k]:.4f}") == 0:
        return f"{there}, at rest all the time"
    when = said(trace.t[k], "s", time_digits(trace.dt))
    return f"{there}, fastest at {when} with {said(velocity[k], 'm/s')}"

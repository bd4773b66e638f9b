"""URDF, written from nothing: for arms that came as tables of numbers, links without shape or mass."""

from __future__ import annotations

import math
from xml.sax.saxutils import quoteattr

from boresight.arm.serial import SerialChain, SerialJoint
from boresight.files.names import xml_comment


def dump_urdf(chain: SerialChain, header_comment: str = "") -> str:
    """Returns the text of a URDF that moves as the chain does.

    Args:
        chain: the arm.
        header_comment: lines to put above it.
    """
    links = [chain.base, *(f"{joint.name}_link" for joint in chain.joints[:-1]), chain.tip]
    lines = ['<?xml version="1.0"?>']
    if header_comment:
        lines.append(f"<!-- {xml_comment(header_comment)} -->")
    lines.append(f"<robot name={quoteattr(chain.name)}>")
    lines += [f"  <link name={quoteattr(link)}/>" for link in links]
    for joint, parent, child in zip(chain.joints, links, links[1:], strict=False):
        lines += _joint(joint, parent, child)
    return "\n".join([*lines, "</robot>"]) + "\n"


def _joint(joint: SerialJoint, parent: str, child: str) -> list[str]:
    unlimited = math.isinf(joint.limits[0])
    kind = "continuous" if joint.type == "revolute" and unlimited else joint.type
    lines = [
        f'  <joint name={quoteattr(joint.name)} type="{kind}">',
        f'    <origin xyz="{_numbers(joint.origin.xyz)}" rpy="{_numbers(joint.origin.rpy)}"/>',
        f"    <parent link={quoteattr(parent)}/>",
        f"    <child link={quoteattr(child)}/>",
    ]
    if joint.type != "fixed":
        lines.append(f'    <axis xyz="{_numbers(joint.axis)}"/>')
    if joint.type != "fixed" and not unlimited:
        # URDF wants effort and velocity, of which geometry knows nothing: 0, which no controller takes for real.
        lines.append(f'    <limit lower="{joint.limits[0]!r}" upper="{joint.limits[1]!r}" effort="0" velocity="0"/>')
    if joint.follows is not None:
        numbers = f'multiplier="{joint.ratio!r}" offset="{joint.offset!r}"'
        lines.append(f"    <mimic joint={quoteattr(joint.follows)} {numbers}/>")
    return [*lines, "  </joint>"]


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(repr(float(value) + 0.0) for value in values)

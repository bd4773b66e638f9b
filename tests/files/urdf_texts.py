"""A small URDF with everything that a careful tool keeps as it is, to be spoiled by the tests."""

URDF = """\
<?xml version="1.0" encoding="utf-8"?>
<!-- made by hand: keep <origin xyz="9 9 9"/> out of it -->
<robot name="two" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base"/><link name="one"/><link name="two"/><link name="tool"/><link name="finger"/>
  <joint name="j1" type="revolute">
    <origin xyz='0  0\t0.3' rpy = "0 0 0" />
    <parent link="base"/>
    <child link="one"/>
    <axis xyz="0 0 1"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/>
  </joint>
  <joint name="j2" type="continuous">
    <parent link="one"/>
    <child link="two"/>
    <origin xyz="0.1 0 0"/> <!-- no rpy -->
    <axis xyz="0 1 0"/>
  </joint>
  <joint name="end" type="fixed">
\t<parent link="two"/>
\t<child link="tool"/>
  </joint>
  <joint name="grip" type="prismatic">
    <parent link="two"/><child link="finger"/><axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
  <transmission name="t"><joint name="j1"><origin xyz="1 2 3"/></joint></transmission>
</robot>
"""


def swapped(*pairs, text=URDF):
    """The text with each `old` replaced by `new`; every old one has to be there."""
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return text


def urdf(body, name="r"):
    """Returns a URDF of links base, a, b, c and a body."""
    links = "".join(f'<link name="{link}"/>' for link in ("base", "a", "b", "c"))
    return f'<robot name="{name}">{links}{body}</robot>'


def joint(name, parent, child, inner="", kind="revolute"):
    """Returns a joint's text."""
    return f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inner}</joint>'

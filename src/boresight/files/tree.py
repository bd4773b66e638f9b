"""The links and joints of a URDF as a tree, and the way from one link to another."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from itertools import islice

from boresight.errors import InputError, did_you_mean
from boresight.files.elements import Element
from boresight.files.problems import Problems, listed, printable, shown

_COMPARED = 500


@dataclass
class Tree:
    """Which joint leads to which link.

    Attributes:
        file: the file's name, for messages.
        links: names of all links, in the file's order.
        joints: the joints' elements by name.
        parent: the parent link of each joint.
        above: the joint that leads to each link that is not a root.
        base, tip: the ends of the chain that was asked for, once it was.
    """

    file: str
    links: list[str]
    joints: dict[str, Element]
    parent: dict[str, str]
    above: dict[str, str]
    base: str = ""
    tip: str = ""

    def chain(self, base: str | None, tip: str | None) -> tuple[str, str, list[Element]]:
        """Returns base link, tip link and the joints between, from the base outwards.

        Args:
            base: the root link by default.
            tip: the only link behind the base that has none behind it by default.

        Raises:
            InputError: there are no such links, or several that could be meant, or no way between them.
        """
        self.base = self._link("base", base) if base is not None else self._only_root()
        self.tip = self._link("tip", tip) if tip is not None else self._only_leaf(self.base)
        way, link = [], self.tip
        while link != self.base and link in self.above:
            way.append(self.above[link])
            link = self.parent[self.above[link]]
        if link != self.base:
            turned = " (base and tip the other way round?)" if self.tip in self._ancestors(self.base) else ""
            raise self._refused(
                f"no joints lead from base {self.base} to tip {self.tip}{turned}; "
                f"the links behind {self.tip} are {listed(reversed(self._ancestors(self.tip)))}"
            )
        if not way:
            raise self._refused(f"base and tip are both {self.base}; expected two links with joints between")
        return self.base, self.tip, [self.joints[name] for name in reversed(way)]

    def _link(self, role: str, name: str) -> str:
        if name not in self.links:
            raise self._refused(
                f"there is no link {shown(name)} for the {role}{nearest(name, self.links)}; "
                f"the links are {listed(self.links)}"
            )
        return name

    def _only_root(self) -> str:
        roots = [link for link in self.links if link not in self.above]
        if len(roots) != 1:
            raise self._refused(f"{len(roots)} links could be the base, {listed(roots)}; name one: base: {roots[0]}")
        return roots[0]

    def _only_leaf(self, base: str) -> str:
        behind: dict[str, list[str]] = {}
        for link, joint in self.above.items():
            behind.setdefault(self.parent[joint], []).append(link)
        reached, ends = [base], set()
        while reached:
            further = behind.get(reached[-1], [])
            if not further:
                ends.add(reached[-1])
            reached[-1:] = further
        leaves = [link for link in self.links if link in ends]
        if len(leaves) != 1:
            raise self._refused(
                f"{len(leaves)} links could be the tip, {listed(leaves)}; name one that carries the sensor: "
                f"tip: {leaves[0] if leaves else self.links[-1]}"
            )
        return leaves[0]

    def _ancestors(self, link: str) -> list[str]:
        above = []
        while link in self.above:
            link = self.parent[self.above[link]]
            above.append(link)
        return above

    def _refused(self, why: str) -> InputError:
        return InputError(printable(f"{self.file}: {why}"))


def nearest(name: str, known: Collection[str]) -> str:
    """Returns " (did you mean X?)" for the nearest of the first names; a file may hold a hundred thousand."""
    return did_you_mean(name[:60], islice(known, _COMPARED))


def tree_of(root: Element, file: str) -> Tree:
    """Returns the tree in a `<robot>` element.

    Raises:
        InputError: everything that keeps it from being one.
    """
    problems = Problems()
    links = _named(root.all("link"), file, problems)
    joints = _named(root.all("joint"), file, problems)
    if not links:
        problems.add(f"{file}: there are no links; expected <link name=...> and joints between them")
    parent: dict[str, str] = {}
    above: dict[str, str] = {}
    for name, joint in joints.items():
        ends = [_end(joint, tag, links, file, problems) for tag in ("parent", "child")]
        if None in ends:
            continue
        parent[name], child = str(ends[0]), str(ends[1])
        if child in above:
            problems.add(
                f"{file}, line {joint.line}: joint {name}: link {child} has a parent already, by joint {above[child]}; "
                "expected a tree"
            )
        else:
            above[child] = name
    problems.raise_if_any()
    _refuse_loops(parent, above, joints, file)
    return Tree(file, list(links), joints, parent, above)


def _named(elements: list[Element], file: str, problems: Problems) -> dict[str, Element]:
    named: dict[str, Element] = {}
    for element in elements:
        name, place = element.attributes.get("name"), f"{file}, line {element.line}: "
        if not name:
            problems.add(f"{place}a {element.name} without a name; expected <{element.name} name=...>")
        elif name in named:
            problems.add(f"{place}{element.name} {name} is there already, on line {named[name].line}")
        else:
            named[name] = element
    return named


def _end(joint: Element, tag: str, links: dict[str, Element], file: str, problems: Problems) -> str | None:
    place = f"{file}, line {joint.line}: joint {joint.attributes['name']}: "
    ends = joint.all(tag)
    if len(ends) != 1:
        problems.add(f"{place}{len(ends)} elements <{tag}>; expected one: <{tag} link=.../>")
        return None
    link = ends[0].attributes.get("link", "")
    if link not in links:
        near = "" if problems.full else nearest(link, links)
        problems.add(f"{place}there is no {tag} link {shown(link)}{near}")
        return None
    return link


def _refuse_loops(parent: dict[str, str], above: dict[str, str], joints: dict[str, Element], file: str) -> None:
    """Raises an error for links that lead back to themselves; each link is walked once."""
    known: set[str] = set()
    for start in above:
        seen: dict[str, None] = {}
        link = start
        while link in above and link not in known:
            if link in seen:
                line = joints[above[link]].line
                raise InputError(printable(f"{file}, line {line}: link {link} leads back to itself; expected a tree"))
            seen[link] = None
            link = parent[above[link]]
        known.update(seen)

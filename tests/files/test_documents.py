"""YAML comes in as plain data with lines, or not at all."""

import math
import os

import pytest

from boresight.errors import InputError
from boresight.files import composing
from boresight.files.documents import read_document


@pytest.fixture
def read(tmp_path):
    def read(content):
        path = tmp_path / "file.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_document(path, "file.yaml")

    return read


@pytest.fixture
def refusal(read):
    def refusal(content):
        with pytest.raises(InputError) as caught:
            read(content)
        return str(caught.value)

    return refusal


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("no", "no"),
        ("yes", "yes"),
        ("1:30", "1:30"),
        ("1_000", "1_000"),
        ("0123", 123),
        ("0o17", 15),
        ("0x1F", 31),
        ("1e-4", 1e-4),
        (".5", 0.5),
        ("-3.", -3.0),
        ("-.inf", -math.inf),
        ("~", None),
        ("2024-01-01", "2024-01-01"),
        ("'5'", "5"),
        ("!!str 5", "5"),
        ("!!float 5", 5),
        ("true", True),
        ("9" * 30, 1e30),
        ("9" * 390, math.inf),
        ("9" * 5000, "9" * 5000),
        ("<<", "<<"),
    ],
)
def test_plain_scalars_follow_the_core_schema_of_yaml_1_2(read, text, value):
    assert read(f"a: {text}").data == {"a": value}


def test_a_yaml_1_1_directive_does_not_turn_no_into_false(read):
    assert read("%YAML 1.1\n---\na: no\n").data == {"a": "no"}


def test_every_key_and_item_knows_its_line(read):
    document = read("a: 1\n\nb:\n  - x\n  - {c: 5,\n     d: 6}\n")
    assert document.data == {"a": 1, "b": ["x", {"c": 5, "d": 6}]}
    assert [document.line_of(p) for p in [("a",), ("b",), ("b", 0), ("b", 1, "c"), ("b", 1, "d")]] == [1, 3, 4, 5, 6]


def test_a_missing_key_has_the_line_of_the_block_it_belongs_in(read):
    assert read("a: 1\nb:\n  c: 2\n").line_of(("b", "nowhere", 3)) == 2


def test_aliases_are_written_out(read):
    assert read("a: &x {k: 1}\nb: [*x, *x]\n").data == {"a": {"k": 1}, "b": [{"k": 1}, {"k": 1}]}


def test_an_alias_bomb_is_refused(refusal):
    bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
    for level in range(1, 12):
        bomb += f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 10)}]\n"
    assert "its aliases, written out, are too many" in refusal(bomb)


def test_aliases_cannot_nest_deeper_than_what_is_written(refusal):
    chain = "a0: &a0 [1]\n" + "".join(f"a{i}: &a{i} [*a{i - 1}]\n" for i in range(1, 100))
    assert "too deep" in refusal(chain)


@pytest.mark.parametrize("text", ["a: &a [*a]", "&a {b: *a}", "a: &a {b: {c: [1, *a]}}"])
def test_a_recursive_alias_is_refused(refusal, text):
    assert refusal(text) == "file.yaml, line 1: the alias *a stands inside what it stands for and would never end"


def test_an_alias_to_nothing_is_refused(refusal):
    assert "stands for nothing" in refusal("a: *b")


@pytest.mark.parametrize(
    "text",
    [
        "a: !!python/object/apply:os.system ['touch owned']",
        "a: !!python/object:os.system {}",
        "!!python/name:os.system a: 1",
        "a: !foo 1",
        "a: !!set {x, y}",
        "a: !!binary aGVsbG8=",
        "a: !!timestamp 2024-01-01",
    ],
)
def test_tags_construct_nothing(refusal, text):
    assert "file.yaml, line 1: the tag " in refusal(text)
    assert not os.path.exists("owned")


def test_all_duplicate_keys_are_told_with_both_lines(refusal):
    assert refusal("a: 1\nb: {c: 1, c: 2}\na: 3\n") == (
        "file.yaml, line 2: the key 'c' is there already, on line 2\n"
        "file.yaml, line 3: the key 'a' is there already, on line 1"
    )


@pytest.mark.parametrize("opening", ["[", "{a: ", "- "])
def test_deep_nesting_is_refused(refusal, opening):
    assert "nested more than 50 deep" in refusal(opening * 2000)


def test_too_many_values_are_refused(refusal, monkeypatch):
    monkeypatch.setattr(composing, "MOST_VALUES", 1000)
    assert "more than 1,000 values" in refusal("[" + "1," * 1001 + "]")


def test_a_second_document_is_refused(refusal):
    assert refusal("a: 1\n---\nb: 2\n") == (
        "file.yaml, line 2: a second document begins here; expected one document in a file"
    )


def test_a_list_cannot_be_a_key(refusal):
    assert "file.yaml, line 1: a key is a list" in refusal("? [1, 2]\n: 3\n")


def test_broken_yaml_names_its_line(refusal):
    assert refusal("a: 1\nb: [1, 2\nc: 3\n").startswith("file.yaml, line 3: not valid YAML: ")


def test_text_that_is_not_utf_8_names_its_line(refusal):
    assert refusal(b"a: 1\nb: \xff\n") == "file.yaml, line 2: not UTF-8 text; save the file as UTF-8"


@pytest.mark.parametrize(
    ("content", "told"), [(b"\x00\x01\x02", "binary or UTF-16"), ("a: 1".encode("utf-16"), "text in UTF-16")]
)
def test_binary_files_are_refused(refusal, content, told):
    assert told in refusal(content)


def test_a_byte_order_mark_is_no_part_of_the_first_key(read):
    assert read(b"\xef\xbb\xbfa: 1\n").data == {"a": 1}


def test_a_file_over_1_mib_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "big.yaml"
    path.touch()
    os.truncate(path, 11 * 2**20)
    with pytest.raises(InputError, match="the file has 11 MiB; expected a YAML file of at most 1 MiB"):
        read_document(path, "big.yaml")


def test_an_empty_file_is_nothing(read):
    assert read("# only a comment\n").data is None


def test_a_pipe_is_refused_without_being_opened(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="not a regular file"):
        read_document(tmp_path / "pipe", "pipe")


def test_a_file_that_may_not_be_read_says_so(tmp_path, monkeypatch):
    path = tmp_path / "file.yaml"
    path.write_text("a: 1")

    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("builtins.open", refuse)
    with pytest.raises(InputError, match=r"file\.yaml: reading it is not permitted"):
        read_document(path, "file.yaml")


def test_what_a_terminal_would_obey_is_escaped(refusal):
    assert "\x1b" not in refusal('a: 1\n"\\e[31m": 1\n"\\e[31m": 2\n')


def test_an_escape_of_no_character_is_told(tmp_path):
    (tmp_path / "a.yaml").write_text('a: "\\UFFFFFFFF"')
    with pytest.raises(InputError, match=r"a\.yaml: not valid YAML: an escape such as \\UFFFFFFFF names no character"):
        read_document(tmp_path / "a.yaml", "a.yaml")

"""A kinematics file read by hand: two levels of keys, a number a line."""


def kinematics(text):
    """Returns the numbers of each block."""
    blocks, block = {}, None
    for line in text.splitlines():
        if line.startswith(("#", "kinematics:")) or "hash:" in line:
            continue
        key, value = line.split(":")
        if line.startswith("    "):
            blocks[block][key.strip()] = float(value)
        else:
            block = key.strip()
            blocks[block] = {}
    return blocks

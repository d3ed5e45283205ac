"""Messages of samples, and ways in which they break."""

GOOD = b'{"t": "2020-02-01T11:00:00Z", "seq": 7, "values": {"current_speed_m_s": 0.5}}'
SEEDS = (
    GOOD,
    b"[" + GOOD + b"," + GOOD.replace(b"7", b"8") + b"]",
    GOOD.replace(b"0.5", b'0.5, "current_to_deg": null'),
)
PIECES = (b"{", b"}", b"[", b"]", b'"', b",", b":", b"null", b"NaN", b"-", b"1e999", b"\x00")


def mutate(random, payload):
    """A payload with some bytes changed, cut out, doubled or put in."""
    content = bytearray(payload)
    for _ in range(int(random.integers(1, 5))):
        at = int(random.integers(len(content) + 1))
        to = min(len(content), at + int(random.integers(1, 12)))
        way = random.integers(5)
        if way == 0 and at < len(content):
            content[at] = int(random.integers(256))
        elif way == 1:
            del content[at:to]
        elif way == 2:
            content[at:at] = content[at:to]
        elif way == 3:
            content[at:at] = PIECES[random.integers(len(PIECES))]
        else:
            content[at:to] = PIECES[random.integers(len(PIECES))]
    return bytes(content)

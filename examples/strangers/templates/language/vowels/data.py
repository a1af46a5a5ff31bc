"""A vowel of the phonetic alphabet, and four others to choose from."""

FRONT, BACK = "iyɪʏeøɛœa", "uɯʊʌoɤɔɑɒ"
HEIGHTS = {"close": "iyuɯ", "near-close": "ɪʏʊ", "close-mid": "eøoɤ", "open-mid": "ɛœɔʌ", "open": "aɑɒ"}
ROUNDED = "yʏøœuʊoɔɒ"


def draw(rng):
    signs = rng.permutation(list(FRONT + BACK))[:5]
    right = str(signs[0])
    height = next(name for name, group in HEIGHTS.items() if right in group)
    place = "front" if right in FRONT else "back"
    lips = "rounded" if right in ROUNDED else "unrounded"
    named = dict(zip(("r", "s", "t", "u", "v"), map(str, signs), strict=True))
    return {"vowel": f"{height} {place} {lips} vowel"} | named

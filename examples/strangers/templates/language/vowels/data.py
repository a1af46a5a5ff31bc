"""Five vowels of the phonetic alphabet, and the description of one of them."""

FRONT, BACK = "iyɪʏeøɛœa", "uɯʊʌoɤɔɑɒ"
HEIGHTS = {
    "close": "iyuɯ",
    "near-close": "ɪʏʊ",
    "close-mid": "eøoɤ",
    "open-mid": "ɛœɔʌ",
    "open": "aɑɒ",
}
ROUNDED = "yʏøœuʊoɔɒ"


def draw(rng):
    signs = [str(sign) for sign in rng.permutation(list(FRONT + BACK))[:5]]
    k = int(rng.integers(1, 6))
    right = signs[k - 1]
    height = next(name for name, group in HEIGHTS.items() if right in group)
    place = "front" if right in FRONT else "back"
    lips = "rounded" if right in ROUNDED else "unrounded"
    return {"vowel": f"{height} {place} {lips} vowel", "k": k} | dict(
        zip("rstuv", signs, strict=True)
    )

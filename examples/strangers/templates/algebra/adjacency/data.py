"""A directed graph on four nodes, without loops."""


def draw(rng):
    edges = [[0] * 4 for _ in range(4)]
    for i in range(4):
        for j in range(i + 1, 4):
            way = rng.integers(0, 3)
            edges[i][j], edges[j][i] = int(way == 1), int(way == 2)
    flat = [cell for row in edges for cell in row]
    if sum(flat) < 3:
        return None
    return {"e": flat}

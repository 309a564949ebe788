"""Reads a DXF file back with ezdxf and holds it against what is known of the gear.

    dxf.py FILE FACTS    FACTS is JSON: base_radius, half_base_angle, teeth, chord_error, gap, area, counts (in mm)

The flank is checked by the closed form of its normal distance: a tangent to the base circle from a point is as long as
the arc that the involute has unrolled.
"""

import json
import math
import sys

import ezdxf

path, facts = sys.argv[1], json.loads(sys.argv[2])
document = ezdxf.readfile(path)
audit = document.audit()
assert not audit.errors and not audit.fixes, [entry.message for entry in audit.errors + audit.fixes]
assert document.dxfversion == "AC1015" and document.header["$INSUNITS"] == 4
entities = list(document.modelspace())
counts = {}
for entity in entities:
    counts[entity.dxftype()] = counts.get(entity.dxftype(), 0) + 1
assert counts == facts["counts"], counts
assert {entity.dxf.layer for entity in entities} <= {"profile", "bore"}
bores = [entity for entity in entities if entity.dxftype() == "CIRCLE"]
contour = [entity for entity in entities if entity.dxf.layer == "profile"]


def points(entity):
    kind = entity.dxftype()
    if kind == "LINE":
        return [entity.dxf.start.vec2, entity.dxf.end.vec2]
    if kind == "ARC":
        return [entity.start_point.vec2, entity.end_point.vec2]
    return [ezdxf.math.Vec2(point) for point in entity.get_points("xy")]


# One behind the other; an arc may lie the other way round, since DXF knows only counterclockwise ones.
ends, turned = [], []
for entity in contour:
    there = points(entity)
    back = False
    if entity.dxftype() == "ARC" and ends:
        back = there[1].distance(ends[-1][1]) < there[0].distance(ends[-1][1])
    elif entity.dxftype() == "ARC":
        # The first one has nothing before it: it ends where the second begins or ends.
        following = points(contour[1])
        near = [min(end.distance(following[0]), end.distance(following[-1])) for end in there]
        back = near[0] < near[1]
    there = there[::-1] if back else there
    ends.append((there[0], there[-1]))
    turned.append(back)
gap = max(one[1].distance(other[0]) for one, other in zip(ends, ends[1:] + ends[:1]))
assert gap < facts["gap"], gap

area = 0.0
for entity, back, (start, end) in zip(contour, turned, ends):
    if entity.dxftype() == "LWPOLYLINE":
        there = points(entity)
        area += 0.5 * sum(a.x * b.y - a.y * b.x for a, b in zip(there, there[1:]))
        continue
    area += 0.5 * (start.x * end.y - start.y * end.x)
    if entity.dxftype() == "ARC":
        turn = math.radians((entity.dxf.end_angle - entity.dxf.start_angle) % 360.0)
        segment = 0.5 * entity.dxf.radius**2 * (turn - math.sin(turn))
        area += -segment if back else segment
area -= sum(math.pi * bore.dxf.radius**2 for bore in bores)
assert abs(area / facts["area"] - 1.0) < 1e-9, (area, facts["area"])

base, half, teeth = facts["base_radius"], facts["half_base_angle"], facts["teeth"]


def from_flank(point):
    """The least distance to any flank of the gear."""
    radius = math.hypot(point.x, point.y)
    if radius < base - 1e-9:
        return math.inf
    tangent = math.sqrt(max(radius - base, 0.0) * (radius + base))
    least = math.inf
    for side in (1.0, -1.0):
        angle = math.atan2(-side * point.x, point.y) + math.atan(tangent / base) + half
        # The tooth whose flank is near.
        pitch = 2.0 * math.pi / teeth
        roll = (angle - tangent / base) - pitch * round((angle - tangent / base) / pitch)
        least = min(least, abs(base * roll))
    return least


farthest, flanks = 0.0, 0
for entity in contour:
    if entity.dxftype() != "LWPOLYLINE":
        continue
    there = points(entity)
    if max(from_flank(point) for point in there) > 1e-9:
        continue  # a root curve
    flanks += 1
    for a, b in zip(there, there[1:]):
        for step in range(1, 10):
            distance = from_flank(a.lerp(b, step / 10))
            # The first chord above the base circle runs below it, where there is no flank.
            farthest = max(farthest, distance if distance < math.inf else 0.0)
assert flanks == 2 * teeth, flanks
assert 0.0 < farthest <= facts["chord_error"], (farthest, facts["chord_error"])
print(f"{len(entities)} entities, area {area:.6f} mm^2, gap {gap:.1e} mm, flank within {farthest:.3e} mm")

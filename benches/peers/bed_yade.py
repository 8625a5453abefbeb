# Yade: grains on a floor, periodic in x and y. STATE, END, STEPS, WARM, GX and GZ come from the environment:
#   STATE=w.txt END=w.end STEPS=100 WARM=200 GX=0 GZ=-9.81 yade -x -n -j1 bed_yade.py
import os
import time

env = os.environ.get
state, end = env("STATE"), env("END")
steps, warm = int(env("STEPS", "100")), int(env("WARM", "200"))
gx, gz = float(env("GX", "0")), float(env("GZ", "-9.81"))
rows = []
for line in open(state):
    if line.startswith("# box"):
        lx, ly = map(float, line.split()[2:4])
    elif not line.startswith("#"):
        rows.append([float(value) for value in line.split()])

# The cell is periodic in z too, and high enough that the top never meets the floor from below.
lift = 0.02
O.periodic = True
O.cell.hSize = Matrix3(lx, 0, 0, 0, ly, 0, 0, 0, 3 * max(row[4] for row in rows) + 0.1)
O.materials.append(FrictMat(young=1e7, poisson=0.3, density=2600, frictionAngle=atan(0.5), label="sand"))
# A box counts as an equal sphere; (1 + √2) E gives its contacts the stiffness of a flat floor of modulus E.
O.materials.append(FrictMat(young=2.41421e7, poisson=0.3, density=2600, frictionAngle=atan(0.5), label="floor"))
O.bodies.append(box(center=(lx / 2, ly / 2, 0), extents=(10.25 * lx, 10.25 * ly, lift), fixed=True, material="floor"))
for row in rows:
    grain = sphere((row[2], row[3], row[4] + lift), row[1], fixed=(row[0] == 2), material="sand")
    if row[0] != 2:
        grain.state.vel, grain.state.angVel = Vector3(row[5:8]), Vector3(row[8:11])
    O.bodies.append(grain)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()], allowBiggerThanPeriod=True, sortAxis=2),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()],
                    [Ip2_FrictMat_FrictMat_MindlinPhys(en=0.5, es=0.5)], [Law2_ScGeom_MindlinPhys_Mindlin()]),
    NewtonIntegrator(damping=0, gravity=(gx, 0, gz), exactAsphericalRot=False),
]
O.dt = 4e-5
O.run(warm, True)
begun = time.time()
O.run(steps, True)
print("Loop time of %g on 1 procs" % (time.time() - begun))
with open(end, "w") as out:
    for index, row in enumerate(rows):
        body = O.bodies[index + 1].state
        place, speed, spin = body.pos, body.vel, body.angVel
        out.write("%d %.12g %.12g %.12g %.12g %g %g %g %g %g %g\n"
                  % (row[0], row[1], place[0], place[1], place[2] - lift, *speed, *spin))

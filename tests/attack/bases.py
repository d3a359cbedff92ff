"""Small cases that between them give every key a use."""

TANK = """title = "tank"
preset = "default"
gravity = [0, 0, -9.81]
tensile = 0.0
xsph = 0.0
[shift]
A = 2
[domain]
min = [0, 0, -0.04]
max = [0.1, 0.08, 0.16]
periodic = [false, true, false]
[domain.reflect]
slip = ["z+"]
[fluid]
model = "wcsph"
dx = 0.01
kernel = "wendland_c2"
h_over_dx = 1.5
variable_h = false
rho0 = 1000
mu = 0.001
vmax = 1.5
c_factor = 10
[[fluid.fill]]
min = [0, 0, 0]
max = [0.05, 0.08, 0.04]
velocity = ["0.1*z", 0, 0]
[eos]
type = "tait"
gamma = 7
background = 0
[pressure]
damper = 0.5
[density]
delta = 0.1
void_relaxation = 0.1
cavitation_limit = 0.1
[visc]
model = "morris"
alpha = 0.01
beta = 0
[drive]
f = [0.1, 0, 0]
factor = "1+x*sin(t)"
mode = "mass"
on = "both"
opposed = "none"
[contact]
normal = "hertz"
kt_ratio = 0.3
tangential_damping = 1
[wall]
dx = 0.01
type = "adami"
slip = "noslip"
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.08, 0.16]
faces = ["x-", "x+", "z-"]
mu = 0.3
mu_r = 0.01
e = 0.8
E = 1e7
nu = 0.3
surface_velocity = [0, 0, 0]
dx = 0.01
[[wall.body]]
name = "raft"
shape = "box"
min = [0.01, 0.02, 0.06]
max = [0.04, 0.05, 0.09]
[wall.body.free]
density = 500
velocity = [0, 0, 0]
spin = [1.0, 0.5, 0.2]
release_time = 0.01
move = "plane"
turn = "axis"
axis = [0, 1, 0]
fluid = true
contacts = true
E = 1e7
nu = 0.3
mu = 0.3
mu_r = 0
e = 0.5
contact_spacing = 0.01
centre_of_mass = [0.025, 0.035, 0.075]
inertia = [2e-6, 2e-6, 2e-6, 0, 0, 0]
[[inlet]]
name = "feed"
shape = "rectangle"
centre = [0.05, 0.04, 0.115]
direction = [0, 0, -1]
half_a = [0.02, 0, 0]
half_b = [0, 0.02, 0]
velocity = 0.3
factor = "1 + 0.1*sin(t)"
ramp = 0.02
start = 0.01
stop = 0.5
[[outlet]]
name = "end"
phase = "both"
shape = "box"
min = [0.085, 0.0, 0.0]
max = [0.1, 0.08, 0.02]
[[contact.pair]]
of = ["grain", "glass"]
mu = 0.25
mu_r = 0.015
e = 0.85
[grain]
d = 0.006
rho = 2500
E = 1e6
nu = 0.3
mu = 0.3
mu_r = 0.01
e = 0.9
release_time = 0
fixed = false
resolve = "auto"
[[grain.material]]
name = "glass"
rho = 2400
E = 1e6
nu = 0.2
mu = 0.2
mu_r = 0.02
e = 0.8
[[grain.fill]]
min = [0.05, 0, 0]
max = [0.08, 0.08, 0.05]
count = 20
velocity = [0, 0, -0.1]
spin = [0, 1, 0]
material = "glass"
[[grain_inlet]]
name = "chute"
min = [0.06, 0.01, 0.12]
max = [0.09, 0.05, 0.14]
rate = 150
velocity = [0, 0, -0.3]
start = 0.01
stop = 0.1
material = "glass"
[couple]
mode = "two_way"
hc = 0.015
kernel = "fluid"
eps_min = 0.3
[drag]
law = "table"
porosity = [0.4, 1]
reynolds = [0, 1, 100]
factor = [10, 12, 50, 1, 1.2, 5]
[time]
end = 0.1
cfl = 0.25
integrator = "kdk"
[run]
seed = 3
precision = "mixed"
max_lost = 0.1
[out]
every = 0.02
diagnostics_every = 0.01
bodies = "all"
contacts = "touching"
walls = true
fields = ["velocity", "pressure"]
[checkpoint]
every = 0.05
[[probe]]
name = "box"
type = "box"
phase = "fluid"
min = [0, 0, 0]
max = [0.1, 0.08, 0.03]
every = 0.002
[[probe]]
name = "in_raft"
type = "point"
body = "raft"
at = [0.025, 0.035, 0.075]
span = [[0.01, 0, 0], [0, 0, 0.005]]
count = [3, 2]
[[probe]]
name = "section"
type = "flux"
phase = "fluid"
direction = "x+"
min = [0.02, 0, 0]
max = [0.04, 0.08, 0.1]
[[probe]]
name = "wp"
type = "force"
body = "tank"
about = [0, 0, 0]
"""

SDPD = """gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.08, 0.08, 0.08]
periodic = [true, true, false]
[fluid]
model = "sdpd_a"
dx = 0.01
kernel = "lucy"
rho0 = 1000
zeta = 1.2
vmax = 0.5
[[fluid.species]]
name = "oil"
mu = 1
[[fluid.species]]
name = "syrup"
mu = 1.2
[[fluid.fill]]
min = [0, 0, 0]
max = [0.08, 0.08, 0.04]
species = "oil"
[[fluid.fill]]
min = [0, 0, 0.04]
max = [0.08, 0.08, 0.08]
species = "syrup"
[eos]
type = "democritus"
p0 = 100
alpha = 7
beta = 1
clip_negative = true
[pressure]
filter = true
damper = 0
linear_exact = false
[density]
method = "continuity"
delta = 0
void_relaxation = 0
cavitation_limit = 0.01
reinit_every = 5
[sdpd]
kT = 1e-9
kI = 0.4
noise = "tensor"
force_scale = [1, 1, 1, 1]
[visc]
model = "none"
alpha = 0
beta = 0
[wall]
type = "frozen"
repulsion = true
rep_D = 1
rep_r0 = 0.005
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.08]
normal = [0, 0, -1]
surface_velocity = [0.1, 0, 0]
[time]
end = 0.1
dt = 1e-4
friction = 0.1
[out]
every = 0.05
[[probe]]
name = "profile"
type = "box"
min = [0, 0, 0]
max = [0.08, 0.08, 0.02]
"""

SHAPES = """[domain]
min = [0, 0, 0]
max = [0.2, 0.2, 0.2]
[[shape]]
name = "brick"
kind = "box"
min = [0, 0, 0]
max = [0.04, 0.04, 0.04]
scale = 1
turn_axis = [0, 0, 1]
turn_angle = 30
translate = [0.1, 0.1, 0.1]
[[shape]]
name = "ball"
kind = "sphere"
centre = [0.05, 0.05, 0.05]
radius = 0.03
[[shape]]
name = "pill"
kind = "capsule"
a = [0.05, 0.05, 0.1]
b = [0.1, 0.05, 0.1]
radius = 0.02
[[shape]]
name = "rod"
kind = "cylinder"
a = [0.15, 0.05, 0.05]
b = [0.15, 0.15, 0.05]
radius = 0.02
[[shape]]
name = "hat"
kind = "cone"
a = [0.1, 0.15, 0.05]
b = [0.1, 0.15, 0.1]
radius_a = 0.03
radius_b = 0.01
[[shape]]
name = "tube"
kind = "pipe"
a = [0.1, 0.1, 0.15]
b = [0.15, 0.1, 0.15]
radius = 0.02
thickness = 0.02
ends = "closed_a"
[[shape]]
name = "rock"
kind = "mesh"
file = "mesh.stl"
repair = true
scale = 0.03
translate = [0.05, 0.15, 0.15]
[[shape]]
name = "pebble"
kind = "sphere"
centre = [0, 0, 0]
radius = 0.01
[[shape]]
name = "ground"
kind = "terrain"
file = "map.asc"
repair = false
thickness = 0.02
scale = 0.05
translate = [0.02, 0.02, 0.03]
[[shape]]
name = "both"
kind = "union"
of = ["ball", "pill"]
[[shape]]
name = "rest"
kind = "difference"
of = ["ball", "pill"]
facet = 0.005
copies = { count = 2, about = [0, 0, 1], centre = [0.1, 0.1, 0.1], angle = 90, along = [0.01, 0, 0] }
[[shape]]
name = "shell"
kind = "hollow"
of = ["ball"]
thickness = 0.02
[fluid]
dx = 0.01
mu = 1
[[fluid.fill]]
shape = "hat"
level = 0.08
[[wall.body]]
name = "brick"
shape = "brick"
type = "single_layer"
force = "monaghan"
dx = 0.005
[[wall.body]]
name = "rod"
shape = "rod"
type = "mdbc"
slip = "slip"
no_penetration = true
repulsion = false
[[wall.body]]
name = "rest"
shape = "rest"
[[wall.body]]
name = "rock"
shape = "rock"
[wall.body.free]
mass = 0.1
move = "none"
turn = "axis"
axis = [0, 1, 0]
point = [0.05, 0.15, 0.15]
contact_radius = 0.01
[[wall.body.free.contact]]
centre = [0.05, 0.15, 0.15]
radius = 0.01
[[wall.body]]
name = "pebble"
shape = "pebble"
[wall.body.free]
density = 2000
[wall.body.free.scatter]
count = 2
min = [0.14, 0.0, 0.0]
max = [0.2, 0.06, 0.06]
gap = 0.001
turned = true
seed = 3
[wall]
suction = true
layer_r0 = 0.01
[[outlet]]
name = "plane"
shape = "plane"
point = [0, 0, 0.01]
normal = [0, 0, -1]
[[outlet]]
name = "solid"
shape = "pill"
[[inlet]]
name = "disc"
shape = "disc"
centre = [0.17, 0.17, 0.17]
direction = [0, 0, -1]
radius = 0.03
rate = 1e-4
[grain]
d = 0.005
settle = true
settle_time = 0.1
settle_mu = 0.1
[[grain.fill]]
shape = "both"
packing_fraction = 0.1
[[grain.fill.sizes]]
kind = "log_normal"
number_fraction = 1
median = 0.005
sigma = 0.1
d_min = 0.004
d_max = 0.006
[[grain.fill]]
min = [0.1, 0.0, 0]
max = [0.2, 0.03, 0.2]
mass = 0.01
[[grain.fill.sizes]]
kind = "sieve"
openings = [0.004, 0.005, 0.006]
passing = [0, 0.5, 1]
[[grain.fill]]
positions = [[0.02, 0.1, 0.02], [0.03, 0.1, 0.02]]
relative = false
velocities = [[0, 0, 0], [0, 0, 0]]
spins = [[0, 0, 0], [0, 0, 1]]
[[grain.fill]]
file = "grains.csv"
[[grain_inlet]]
name = "drop"
shape = "disc"
centre = [0.17, 0.05, 0.17]
direction = [0, 0, -1]
radius = 0.02
mass_rate = 0.01
[[grain_inlet.sizes]]
kind = "uniform"
mass_fraction = 1
d_min = 0.004
d_max = 0.006
[[grain_inlet.sizes]]
kind = "class"
mass_fraction = 1
d = 0.005
[time]
end = 0.1
[out]
every = 0.05
[[probe]]
name = "front"
type = "front"
direction = "x+"
[[probe]]
name = "height"
type = "height"
at = [0.1, 0.15, 0.05]
along = [1, 0, 1]
[[probe]]
name = "field"
type = "field"
at = [0.1, 0.1, 0.05]
span = [[0.05, 0, 0], [0, 0.03, 0.02]]
count = [3, 2]
radius = 0.02
sample_every = 0.01
[[probe]]
name = "wall"
type = "wall_pressure"
body = "rod"
at = [0.13, 0.1, 0.05]
radius = 0.01
"""

MOTIONS = """gravity = [0, 0, -9.81]
[domain]
min = [-0.02, -0.02, -0.02]
max = [0.12, 0.12, 0.12]
[fluid]
dx = 0.01
vmax = 2
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.03, 0.03]
[[wall.body]]
name = "tank"
shape = "tank"
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[[wall.body]]
name = "formula"
shape = "box"
min = [0.02, 0.05, 0.03]
max = [0.04, 0.07, 0.05]
[wall.body.motion]
kind = "formula"
displacement = ["0.01*sin(t)", "0", "0"]
rotation = ["0", "10*sin(t)", "0"]
centre = [0.03, 0.06, 0.04]
start = 0.01
stop = 0.3
remove_when_clear = false
[[wall.body.motion.add]]
kind = "velocity"
velocity = [0.01, 0, 0]
start = 0.1
stop = 0.2
[[wall.body.motion.add]]
kind = "oscillation"
amplitude = [0.01, 0, 0]
frequency = 2
[[wall.body.motion.add]]
kind = "rotation"
axis = [0, 0, 1]
centre = [0.03, 0.06, 0.04]
rate = 1
[[wall.body.motion.add]]
kind = "table"
rows = [[0, 0, 0, 0], [0.5, 0.01, 0, 0], [1, 0, 0, 0]]
spline = "monotone"
[[wall.body.motion.add]]
kind = "piston"
wave_height = 0.005
wave_period = 1.0
wave_depth = 0.1
wave_order = 1
wave_direction = [1, 0, 0]
wave_ramp = 0.5
[[wall.body.motion.add]]
kind = "table"
file = "motion.csv"
[[wall.body.motion.add]]
kind = "formula"
displacement = ["0.001*t^2", "0", "0"]
rotation = ["0", "0", "t^2"]
[[wall.body]]
name = "turning"
shape = "box"
min = [0.06, 0.05, 0.05]
max = [0.08, 0.07, 0.07]
[wall.body.motion]
kind = "rotation"
axis = [0, 1, 0]
centre = [0.07, 0.06, 0.06]
rate = "10 rpm"
[[wall.body]]
name = "swinging"
shape = "box"
min = [0.06, 0.05, 0.08]
max = [0.08, 0.07, 0.1]
[wall.body.motion]
kind = "oscillation"
amplitude = [0.01, 0, 0]
frequency = 2
[[wall.body]]
name = "listed"
shape = "box"
min = [0.02, 0.07, 0.06]
max = [0.04, 0.09, 0.08]
[wall.body.motion]
kind = "table"
rows = [[0, 0, 0, 0], [0.5, 0.01, 0, 0], [1, 0, 0, 0]]
spline = "smooth"
[[wall.body]]
name = "file"
shape = "box"
min = [0.02, 0.02, 0.08]
max = [0.04, 0.04, 0.1]
[wall.body.motion]
kind = "table"
file = "motion.csv"
[[wall.body]]
name = "straight"
shape = "box"
min = [0.06, 0.02, 0.08]
max = [0.08, 0.04, 0.1]
[wall.body.motion]
kind = "velocity"
velocity = [0, 0.01, 0]
[frame.motion]
kind = "formula"
displacement = ["0.01*sin(10*t)", "0", "0"]
start = 0
stop = 0.5
[[frame.motion.add]]
kind = "oscillation"
amplitude = [0.001, 0, 0]
frequency = 2
[[frame.motion.add]]
kind = "velocity"
velocity = [0.01, 0, 0]
start = 0.1
stop = 0.2
[[frame.motion.add]]
kind = "table"
rows = [[0, 0, 0, 0], [0.5, 0.01, 0, 0], [1, 0, 0, 0]]
[[frame.motion.add]]
kind = "formula"
displacement = ["0.001*t^2", "0", "0"]
[time]
end = 1
[out]
every = 0.5
"""

SLURRY = """gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
periodic = [true, true, true]
two_d = false
[fluid]
dx = 0.01
mu = 0.1
vmax = 0.5
variable_h = false
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[visc]
collision = true
collision_range = 0.8
collision_restitution = 0.5
[drive]
rate = [0, 0, 0]
centre = [0.05, 0.05, 0.05]
[contact]
normal = "linear"
tangential = "linear"
rolling = "epsd"
k = 1000
eta_r = 0.1
cap_rolling = true
clip_tension = true
[lubrication]
forces = "all"
cut_off = 0.25
least_gap = 0.01
[grain]
d = 0.008
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
every = [5, 5, 5]
replaces_fluid = true
[[grain.fill]]
positions = [[0.031, 0.031, 0.031], [0.031, 0.031, 0.039]]
[grain.fill.rigid]
move = "axis"
turn = "axis"
axis = [0, 0, 1]
[couple]
undisturbed = true
own_hc = true
between = "refuse"
S_dry = 0.1
S_wet = 0.2
torque = true
angmom = true
slip = "mean"
spreading = 1
wall_normalise = true
[drag]
law = "di_felice"
integrator = "exponential"
[time]
end = 0.1
force_dt = true
dt_dem = 1e-5
visc = 0.125
body = 0.25
drag = 0.5
rayleigh = 0.2
contact = 0.05
[run]
skin_fluid = 0.2
skin_grain = 0.2
simd = "auto"
[out]
every = 0.05
[paper]
he_damping = true
he_tensile = false
[[probe]]
name = "field"
type = "point"
at = [0.05, 0.05, 0.05]
"""

SHEAR = """gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
periodic = [true, true, true]
shear_rate = 1
[fluid]
dx = 0.01
mu = 1
vmax = 0.2
[[fluid.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[time]
end = 0.1
[out]
every = 0.05
"""

LISTED = """gravity = [0, 0, 0]
[domain]
min = [0, 0, 0]
max = [0.2, 0.2, 0.1]
periodic = [true, true, false]
[domain.reflect]
no_slip = ["z+"]
[fluid]
dx = 0.01
vmax = 0.2
variable_h = true
sigma_h = 1.5
[[fluid.fill]]
file = "fluid.csv"
[time]
end = 0.1
[out]
every = 0.05
"""

NODES = """gravity = [0, 0, -9.81]
[domain]
min = [0, 0, 0]
max = [0.02, 0.02, 0.02]
periodic = [true, true, false]
[fluid]
model = "lattice"
dx = 0.002
mu = 0.05
vmax = 0.1
[[fluid.fill]]
min = [0, 0, 0]
max = [0.02, 0.02, 0.02]
velocity = ["0.01*sin(314.159*y)", 0, 0]
[lattice]
collision = "trt"
magic = 0.1875
velocity = 0.05
tau_max = 1
mass_every = 20
[drive]
f = [1, 0, 0]
factor = "cos(t)"
[[wall.body]]
name = "floor"
shape = "plane"
point = [0, 0, 0]
normal = [0, 0, 1]
[[wall.body]]
name = "lid"
shape = "plane"
point = [0, 0, 0.02]
normal = [0, 0, -1]
surface_velocity = [0.01, 0, 0]
[time]
end = 0.02
[out]
every = 0.01
[[probe]]
name = "lid"
type = "force"
body = "lid"
"""

CLUMPS = """gravity = [0, 0, -9.81]
[domain]
min = [0, 0, 0]
max = [0.1, 0.1, 0.1]
[[clump]]
name = "rod"
spheres = [[-1, 0, 0, 1], [0, 0, 0, 1], [1, 0, 0, 1]]
density = 2700
[[clump]]
name = "drop"
file = "drop.txt"
[[clump]]
name = "stone"
shape = "rock"
count = 8
drag = "members"
[[shape]]
name = "rock"
kind = "box"
min = [0, 0, 0]
max = [1, 1, 2]
[grain]
d = 0.006
[[grain.fill]]
min = [0, 0, 0]
max = [0.1, 0.1, 0.05]
count = 20
clump = "drop"
[[grain.fill]]
positions = [[0.05, 0.05, 0.08]]
clump = "rod"
orientation = [0, 90, 0]
[[grain_inlet]]
name = "feed"
min = [0.02, 0.02, 0.06]
max = [0.08, 0.08, 0.09]
rate = 50
clump = "stone"
orientation = [0, 0, 30]
[[outlet]]
name = "foot"
min = [0, 0, 0]
max = [0.1, 0.1, 0.01]
[time]
end = 0.1
[out]
every = 0.05
"""

BASES = {"tank": TANK, "sdpd": SDPD, "shapes": SHAPES, "motions": MOTIONS, "slurry": SLURRY, "shear": SHEAR, "listed": LISTED,
         "nodes": NODES, "clumps": CLUMPS}

_FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
_CORNERS = ["0 0 0", "1 0 0", "0 1 0", "0 0 1"]
MESH = "solid rock\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {_CORNERS[k]}\n" for k in face) + "endloop\nendfacet\n"
    for face in _FACES
) + "endsolid rock\n"
FILES = {
    "mesh.stl": MESH,
    "map.asc": "ncols 3\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1\n0 0.1 0\n0 0.2 0.1\n",
    "motion.csv": "t [s],x [m],y [m],z [m]\n0,0,0,0\n0.5,0.001,0,0\n1,0,0,0\n",
    "drop.txt": "# x y z r\n0 0 0 1\n0 0 1.2 0.7\n",
    "grains.csv": "x [m],y [m],z [m],d [m]\n0.02,0.02,0.15,0.005\n0.03,0.02,0.15,0.005\n",
    "fluid.csv": "x [m],y [m],z [m]\n"
    + "".join(f"{0.005 + 0.01 * i},{0.005 + 0.01 * j},{0.005 + 0.01 * k}\n" for k in range(10) for j in range(20) for i in range(20)),
}

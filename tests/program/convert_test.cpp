// Cases of other programs, and frames in other formats, as a user converts them.

#include <cmath>
#include <iterator>
#include <regex>
#include <vector>

#include "bedload/case/formula.hpp"
#include "run_program.hpp"
#include "src/motion/wave_maker.hpp"
#include "tests/support/cases.hpp"

namespace bedload::test {
namespace {

/// A case of DualSPHysics: constants, the domain in which it draws, commands, what else defines it, what
/// runs it.
std::string dual(const std::string& domain, const std::string& commands, const std::string& more = "",
                 const std::string& parameters = "", const std::string& special = "") {
  return R"(<?xml version="1.0" encoding="UTF-8" ?>
<case>
  <casedef>
    <constantsdef>
      <gravity x="0" y="0" z="-9.81" />
      <rhop0 value="1000" />
      <coefsound value="20" />
      <coefh value="0.866025" />
      <cflnumber value="0.2" />
    </constantsdef>
    <geometry>
      <definition dp="0.01">)" +
         domain + R"(</definition>
      <commands><mainlist>
)" + commands +
         R"(
      </mainlist></commands>
    </geometry>
)" + more +
         R"(
  </casedef>
  <execution>
    <special>)" +
         special + R"(</special>
    <parameters>
      <parameter key="ViscoTreatment" value="2" />
      <parameter key="Visco" value="1e-6" />
      <parameter key="DensityDT" value="2" />
      <parameter key="TimeMax" value="0.04" />
      <parameter key="TimeOut" value="0.02" />
)" + parameters +
         R"(
    </parameters>
  </execution>
</case>
)";
}

std::string box(const std::string& fill, const std::string& point, const std::string& size) {
  return "<drawbox><boxfill>" + fill + "</boxfill><point " + point + " /><size " + size + " /></drawbox>\n";
}

const std::string kRoom = R"(<pointmin x="-0.05" y="-0.05" z="-0.05" /><pointmax x="1" y="1" z="1" />)";
const std::string kFluid = "<setmkfluid mk=\"0\" />\n", kBound = "<setmkbound mk=\"0\" />\n";
const std::string kTank = kBound + box("bottom | left | right | front | back", R"(x="0" y="0" z="0")",
                                       R"(x="0.4" y="0.2" z="0.3")");
const std::string kDam =
    kFluid + box("solid", R"(x="0" y="0" z="0")", R"(x="#Dp*10" y="0.2" z="0.15")") + kTank;

class Convert : public ProgramTest {
 protected:
  /// What is said of a case that is converted and passes `check`.
  std::string converted(const std::string& from, const std::string& to) {
    const Outcome o = bedload("convert " + from);
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("wrote " + to), std::string::npos) << o.out;
    const Outcome check = bedload("check " + to + " --backend cpu");
    EXPECT_EQ(check.code, 0) << check.err << content_of(dir_ / to);
    checked_ = check.out;
    return o.err;
  }
  /// Of the last case checked.
  int particles(const std::string& phase) const {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(checked_, found, std::regex(phase + " ([0-9 ]+)"))) << checked_;
    std::string digits = found[1];
    std::erase(digits, ' ');
    return std::stoi(digits);
  }
  bool has_line(const std::string& file, const std::string& line) const {
    return content_of(dir_ / file).find(line + '\n') != std::string::npos;
  }
  /// Columns 1 to 7 of the last row of bodies/<name>.csv: centre, rotation as a quaternion; 0: the time.
  std::vector<double> last_row(const std::string& name) const {
    std::string text = content_of(dir_ / "out/bodies" / (name + ".csv"));
    text.pop_back();
    std::stringstream row(text.substr(text.rfind('\n') + 1));
    std::vector<double> out;
    for (std::string word; std::getline(row, word, ',');) out.push_back(std::stod(word));
    EXPECT_GT(out.size(), 7u) << name;
    return out;
  }
  void run(const std::string& file) {
    const Outcome o = bedload("run " + file + " --backend cpu --quiet --out out --overwrite");
    ASSERT_EQ(o.code, 0) << o.err;
  }
  std::string checked_;
};

TEST_F(Convert, DamBreakWithABuilding) {
  write("CaseDam_Def.xml",
        dual(kRoom,
             kDam + "<setmkvoid />\n" +
                 box("solid", R"(x="0.2" y="0.1" z="0")", R"(x="0.08" y="0.06" z="0.2")") +
                 "<setmkbound mk=\"1\" />\n" +
                 box("top | left | right | front | back", R"(x="0.2" y="0.1" z="0")",
                     R"(x="0.08" y="0.06" z="0.2")"),
             "", R"(<parameter key="IncZ" value="1" /><parameter key="Boundary" value="2" />)",
             R"(<damping active="true"><dampingzone /></damping>
                <gauges><swl name="gauge 1"><computedt value="0.001" /><point0 x="0.05" y="0.1" z="0" /></swl></gauges>)"));
  const std::string left = converted("CaseDam_Def.xml", "CaseDam.toml");
  EXPECT_EQ(particles("fluid"), 10 * 20 * 15);                     // 0.1 m x 0.2 m x 0.15 m
  EXPECT_TRUE(has_line("CaseDam.toml", "max = [0.4, 0.2, 0.6]"));  // IncZ doubles the height
  EXPECT_TRUE(has_line("CaseDam.toml", "faces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]"));
  EXPECT_TRUE(has_line("CaseDam.toml",
                       "name = \"bound_1\"\nshape = \"box\"\nmin = [0.2, 0.1, 0]\nmax = [0.28, 0.16, 0.2]"));
  EXPECT_TRUE(has_line("CaseDam.toml", "[wall]\ntype = \"mdbc\""));
  EXPECT_TRUE(
      has_line("CaseDam.toml", "name = \"gauge_1\"\ntype = \"height\"\nat = [0.05, 0.1, 0]\nevery = 0.001"));
  EXPECT_NE(left.find("CaseDam_Def.xml:28: <damping>: there is no wave absorber"), std::string::npos) << left;
  EXPECT_NE(content_of(dir_ / "CaseDam.toml").find("# - CaseDam_Def.xml:28: <damping>"), std::string::npos);
  // the sound speed of coefsound 20 over sqrt(g H), in a case whose speed is sqrt(2 g H)
  EXPECT_NE(checked_.find("sound 24.26 m/s"), std::string::npos) << checked_;
}

TEST_F(Convert, PlaneFlowWithAGateThatRises) {
  write("Gate_Def.xml",
        dual(R"(<pointmin x="-0.05" y="0.1" z="-0.05" /><pointmax x="1" y="0.1" z="1" />)",
             kFluid + box("solid", R"(x="0" y="-1" z="0")", R"(x="0.1" y="2" z="0.15")") + kBound +
                 box("bottom | left | right | top", R"(x="0" y="-1" z="0")", R"(x="0.4" y="2" z="0.4")") +
                 "<setmkbound mk=\"3\" />\n" +
                 box("solid", R"(x="0.1" y="-1" z="0")", R"(x="0.05" y="2" z="0.3")"),
             R"(<motion><objreal ref="3">
                  <begin mov="1" start="0.01" />
                  <mvrectace id="1" duration="0.02" next="2"><ace x="0" y="0" z="2" /></mvrectace>
                  <mvrect id="2" duration="1"><vel x="0" y="0" z="0.04" /></mvrect>
                </objreal></motion>)"));
  converted("Gate_Def.xml", "Gate.toml");
  EXPECT_EQ(particles("fluid"), 10 * 15);
  EXPECT_TRUE(has_line("Gate.toml", "two_d = true  # forces and masses are those of 1 m along y"));
  run("Gate.toml");
  const auto row = last_row("bound_3");  // 2 m/s2 over 0.02 s, then 0.04 m/s
  EXPECT_NEAR(row[3], 0.5 * 2 * 0.02 * 0.02 + 0.04 * (row[0] - 0.03), 1e-9);
}

TEST_F(Convert, PaddlesThatOscillateAndTurn) {
  write("Paddle_Def.xml",
        dual(kRoom,
             kDam + "<setmkbound mk=\"1\" />\n" +
                 box("solid", R"(x="0.15" y="0.05" z="0.05")", R"(x="0.04" y="0.1" z="0.1")") +
                 "<setmkbound mk=\"2\" />\n" +
                 box("solid", R"(x="0.25" y="0.05" z="0.1")", R"(x="0.06" y="0.1" z="0.06")"),
             R"(<motion>
                  <objreal ref="1"><begin mov="7" start="0" />
                    <mvrectsinu id="7" duration="9" anglesunits="degrees">
                      <freq x="4" y="0" z="0" /><ampl x="0.02" y="0" z="0" /><phase x="90" y="0" z="0" />
                    </mvrectsinu></objreal>
                  <objreal ref="2"><begin mov="1" start="0" />
                    <mvrot id="1" duration="9" anglesunits="degrees"><vel ang="-90" />
                      <axisp1 x="0.28" y="0" z="0.13" /><axisp2 x="0.28" y="1" z="0.13" /></mvrot></objreal>
                </motion>)",
             R"(<parameter key="IncZ" value="1" />)"));
  converted("Paddle_Def.xml", "Paddle.toml");
  EXPECT_EQ(particles("fluid"), 3000);
  run("Paddle.toml");
  const auto shifted = last_row("bound_1"), turned = last_row("bound_2");
  const double t = shifted[0];
  EXPECT_NEAR(shifted[1], 0.02 * (std::sin(2 * M_PI * 4 * t + M_PI / 2) - 1), 1e-9);
  EXPECT_NEAR(turned[6], std::sin(-M_PI / 2 * t / 2), 1e-9);  // half the angle, about y
}

TEST_F(Convert, PistonOfAWaveFlume) {
  write(
      "Waves_Def.xml",
      dual(R"(<pointmin x="-0.5" y="0" z="-0.05" /><pointmax x="3" y="0" z="1" />)",
           kFluid + box("solid", R"(x="0" y="-1" z="0")", R"(x="2" y="2" z="0.2")") + kBound +
               box("bottom | left | right | top", R"(x="-0.1" y="-1" z="0")", R"(x="2.1" y="2" z="0.4")") +
               "<setmkbound mk=\"10\" />\n" +
               box("solid", R"(x="-0.06" y="-1" z="0")", R"(x="0.06" y="2" z="0.35")"),
           R"(<motion><objreal ref="10"><begin mov="1" start="0" /><mvnull id="1" /></objreal></motion>)", "",
           R"(<wavepaddles><piston><mkbound value="10" /><waveorder value="2" /><depth value="0.2" />
                <waveheight value="0.02" /><waveperiod value="0.8" /><ramp value="0" /></piston>
                <piston_spectrum><mkbound value="11" /></piston_spectrum></wavepaddles>)"));
  const std::string left = converted("Waves_Def.xml", "Waves.toml");
  EXPECT_EQ(particles("fluid"), 200 * 20);
  EXPECT_TRUE(has_line("Waves.toml",
                       "kind = \"piston\"\nwave_height = 0.02\nwave_period = 0.8\nwave_depth = "
                       "0.2\nwave_order = 2\nwave_ramp = 0"));
  EXPECT_NE(left.find("<piston_spectrum>: wave makers are for regular waves"), std::string::npos) << left;
  run("Waves.toml");
  const WaterWave wave{.height = 0.02, .period = 0.8, .depth = 0.2, .gravity = 9.81};
  const auto row = last_row("bound_10");
  EXPECT_NEAR(row[1], Formula(piston_stroke(wave, 2, 0), "t")(row[0]), 1e-9);
}

TEST_F(Convert, VesselFilledFromASeedWithAFloat) {
  write(
      "Drum_Def.xml",
      dual(
          kRoom,
          "<setdrawmode mode=\"face\" />\n" + kBound +
              R"(<drawcylinder radius="0.15"><point x="0.2" y="0" z="0.2" /><point x="0.2" y="0.2" z="0.2" /></drawcylinder>
                        <setdrawmode mode="full" /><setmkbound mk="4" />
                        <drawsphere radius="0.04"><point x="0.2" y="0.1" z="0.24" /></drawsphere>)" +
              kFluid + R"(<fillbox x="0.2" y="0.1" z="0.1"><modefill>void</modefill>
                          <point x="0" y="0" z="0" /><size x="0.4" y="0.2" z="0.2" /></fillbox>)",
          R"(<floatings><floating mkbound="4" rhopbody="600"><linearvelini x="0.1" y="0" z="0" />
                  <translationDOF x="1" y="0" z="1" /></floating></floatings>)"));
  converted("Drum_Def.xml", "Drum.toml");
  // half of the cylinder; particles of its rim and of the float's cap are in or out
  const double half = M_PI / 2 * 0.15 * 0.15 * 0.2 / 1e-6;
  EXPECT_NEAR(particles("fluid"), half, 0.02 * half);
  EXPECT_TRUE(has_line("Drum.toml", "kind = \"hollow\"\nof = [\"bound_0_inside\"]"));
  EXPECT_TRUE(
      has_line("Drum.toml", "density = 600\nvelocity = [0.1, 0, 0]\nmove = \"plane\"\naxis = [0, 1, 0]"));
}

TEST_F(Convert, BoxTurnedAfterItIsDrawn) {
  write("Turned_Def.xml",
        dual(kRoom,
             kDam + "<_drawpoint x=\"9\" y=\"9\" z=\"9\" />\n<setmkbound mk=\"3\" />\n" +
                 box("all ^ top ^ bottom", R"(x="0.25" y="0.05" z="0")", R"(x="0.04" y="0.1" z="0.05")"),
             R"(<initials><_move mkfluid="0" x="9" y="0" z="0" /><move mkfluid="0" x="0.02" y="0" z="0" />
                  <rotateaxis mkbound="3" angle="90" anglesunits="degrees">
                  <axisp1 x="0.25" y="0.1" z="0" /><axisp2 x="0.25" y="0.1" z="1" /></rotateaxis></initials>)"));
  const std::string left = converted("Turned_Def.xml", "Turned.toml");
  EXPECT_EQ(particles("fluid"), 3000);
  EXPECT_TRUE(has_line("Turned.toml", "max = [0.4, 0.2, 0.3]"));  // the box stays in the tank
  EXPECT_TRUE(has_line("Turned.toml", "min = [0.02, 0, 0]\nmax = [0.12, 0.2, 0.15]"));
  // about (0.25, 0.1): x' = 0.35 - y, y' = x - 0.15
  EXPECT_TRUE(has_line("Turned.toml",
                       "min = [0.25, 0.05, 0]\nmax = [0.29, 0.15, 0.05]\nturn_axis = [0, 0, "
                       "1]\nturn_angle = 90\ntranslate = [0.35, -0.15, 0]"));
  EXPECT_EQ(left.find("rotateaxis"), std::string::npos) << left;
  EXPECT_EQ(left.find('_' + std::string("drawpoint")), std::string::npos) << left;
}

TEST_F(Convert, FluidFilledUpToAPiston) {
  write("Fill_Def.xml",
        dual(R"(<pointmin x="-0.5" y="0" z="-0.05" /><pointmax x="1" y="0" z="1" />)",
             "<setmkbound mk=\"10\" />\n" +
                 box("solid", R"(x="-0.03" y="-1" z="0")", R"(x="0.03" y="2" z="0.3")") + kBound +
                 box("bottom | right", R"(x="-0.2" y="-1" z="0")", R"(x="0.6" y="2" z="0.3")") + kFluid +
                 R"(<fillbox x="0.1" y="0" z="0.05"><modefill>void</modefill>
                      <point x="-0.5" y="-1" z="-0.05" /><size x="1.5" y="2" z="0.15" /></fillbox>)",
             "", "",
             R"(<gauges><swl name="front"><point0 x="-0.05" y="0" z="0.03" /><point2 x="0.5" y="0" z="0.03" />
                </swl></gauges>)"));
  converted("Fill_Def.xml", "Fill.toml");
  EXPECT_EQ(particles("fluid"), 40 * 10);  // from the piston at 0 to the wall at 0.4 m, 0.1 m deep
  EXPECT_TRUE(
      has_line("Fill.toml", "name = \"front\"\ntype = \"front\"\nphase = \"fluid\"\ndirection = \"x+\""));
}

TEST_F(Convert, MeshFromAFileAndAnOpening) {
  std::filesystem::create_directory(dir_ / "cad");
  // a tetrahedron of 1/6 of 60 mm x 60 mm x 60 mm
  write("cad/wedge.obj", "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  write(
      "Wedge_Def.xml",
      dual(
          kRoom,
          kDam + "<setmkbound mk=\"5\" />\n" +
              R"(<drawfileply file="cad/wedge.obj" autofill="true"><drawscale x="0.001" y="0.001" z="0.001" />
                           <drawmove x="0.3" y="0.05" z="0" /></drawfileply>
                        )" +
              "<setmkbound mk=\"6\" />\n" +
              box("solid", R"(x="0.15" y="0" z="0")", R"(x="0.06" y="0.2" z="0.2")") + "<setmkvoid />\n" +
              box("solid", R"(x="0.15" y="0.05" z="0.05")", R"(x="0.06" y="0.1" z="0.1")")));
  converted("Wedge_Def.xml", "Wedge.toml");
  EXPECT_TRUE(has_line("Wedge.toml", "kind = \"mesh\"\nfile = \"cad/wedge.obj\"\nscale = 0.001"));
  EXPECT_TRUE(has_line("Wedge.toml", "kind = \"difference\"\nof = [\"bound_6_whole\", \"opening\"]"));
  EXPECT_EQ(particles("fluid"), 3000);
}

TEST_F(Convert, WritesFromLiggghts) {
  write("in.drum", R"(# grains in a box, a wall that shakes
atom_style granular
units si
boundary f p f
variable radius equal 0.004
variable mass equal 4/3*PI*v_radius^3*2400*50
region reg block 0 0.1 0 0.05 0 &
  0.1 units box
create_box 2 reg
neighbor 0.002 bin
fix m1 all property/global youngsModulus peratomtype 5e6 2e7
fix m2 all property/global poissonsRatio peratomtype 0.45 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.7 0.6 0.6 0.5
fix m4 all property/global coefficientFriction peratomtypepair 2 0.5 0.25 0.25 0.1
fix m5 all property/global coefficientRollingFriction peratomtypepair 2 0.1 0.1 0.1 0.1
pair_style gran model hertz tangential history rolling_friction cdt
timestep 0.00001
fix g all gravity 9.81 vector 0 0 -1
fix floor all wall/gran model hertz tangential history primitive type 2 zplane 0
fix left all wall/gran model hertz tangential history primitive type 1 xplane 0
fix right all wall/gran model hertz tangential history primitive type 1 xplane 0.1
fix pts1 all particletemplate/sphere 15485863 atom_type 1 density constant 2400 radius constant ${radius}
fix pdd1 all particledistribution/discrete 15485867 1 pts1 1.0
region fill cylinder z 0.05 0.025 0.02 0.01 0.09 units box
fix ins all insert/pack seed 32452843 distributiontemplate pdd1 vel constant 0 0 -0.1 insert_every once overlapcheck yes all_in yes mass_in_region ${mass} region fill
fix integr all nve/sphere
fix heat all heat/gran initial_temperature 300
dump d all custom 1000 post/dump*.txt id x y z
run 4000
)");
  const std::string left = converted("in.drum", "drum.toml");
  EXPECT_EQ(particles("grains"), 50);
  for (const char* line :
       {"d = 0.008    # m", "rho = 2400   # kg/m3", "E = 5000000  # Pa", "mu = 0.5", "e = 0.7",
        "periodic = [false, true, false]", "rolling = \"cdt\"", "end = 0.04  # s", "every = 0.01  # s",
        "name = \"floor\"\nshape = \"plane\"\npoint = [0.05, 0.025, 0]\nnormal = [0, 0, 1]\nE = 20000000\nnu "
        "= 0.3\n"
        "mu = 0.25\ne = 0.6",
        "point = [0.1, 0.025, 0.05]\nnormal = [-1, 0, 0]", "velocity = [0, 0, -0.1]"})
    EXPECT_TRUE(has_line("drum.toml", line)) << line << "\nin\n" << content_of(dir_ / "drum.toml");
  EXPECT_NE(left.find("in.drum:27: fix heat heat/gran: there is no heat"), std::string::npos) << left;
}

TEST_F(Convert, SaysWhatIsWrong) {
  const auto refused = [&](const std::string& arguments) {
    const Outcome o = bedload("convert " + arguments);
    EXPECT_EQ(o.code, 2) << o.out;
    return o.err;
  };
  write("a.xml", dual(kRoom, kFluid + box("solid", R"(x="0" y="0" z="0")", R"(x="Width" y="1" z="1")")));
  EXPECT_EQ(
      refused("a.xml"),
      "a.xml:15: <size> x=\"Width\" must be a number or an expression: names Width, which has no value\n");
  write("b.xml", "<case>\n<casedef>\n</case>\n");
  EXPECT_TRUE(refused("b.xml").starts_with("b.xml:3: is not valid XML: ")) << refused("b.xml");
  write("c.xml", "<mesh />");
  EXPECT_EQ(refused("c.xml"), "c.xml: is not a case of DualSPHysics: it must hold <case> with <casedef>\n");
  EXPECT_EQ(refused("none.xml"), "none.xml: cannot read: no such file or folder\n");
  write("in.a", "units lj\n");
  EXPECT_EQ(refused("in.a"), "in.a:1: units lj must be si: other units are not converted\n");
  write("in.b", "\nregion r block 0 1 0 ${wide} 0 1\n");
  EXPECT_EQ(refused("in.b"), "in.b:2: region uses the variable wide, which has no value\n");
  write("a.xml", dual(kRoom, kDam));
  write("a.toml", "mine");
  EXPECT_EQ(refused("a.xml"), "a.toml: exists; add --overwrite, or name another file with --out\n");
  EXPECT_EQ(content_of(dir_ / "a.toml"), "mine");
  EXPECT_EQ(bedload("convert a.xml --overwrite").code, 0);
  EXPECT_EQ(refused("a.xml --to lammps"),
            "command line: --to lammps: only frames, a results folder or a .vtkhdf file, have formats\n");
  EXPECT_EQ(refused("."), ".: has no frames of fluid or grains (fluid.vtkhdf, grains.vtkhdf)\n");
}

TEST_F(Convert, WritesFramesForOvito) {
  write("dam.toml", small_dam() + "[time]\nend = 0.02\n[out]\nevery = 0.01\n");
  run("dam.toml");
  const Outcome o = bedload("convert out");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_EQ(o.out, "wrote out/frames.extxyz with 3 frames\n");
  std::stringstream text(content_of(dir_ / "out/frames.extxyz"));
  std::string line;
  int frames = 0;
  while (std::getline(text, line)) {
    const int count = std::stoi(line);
    std::getline(text, line);
    EXPECT_EQ(line.find("Lattice=\""), 0u);
    EXPECT_NE(line.find("Properties=species:S:1:pos:R:3:velo:R:3"), std::string::npos) << line;
    const auto fields = [](const std::string& of) {
      std::istringstream words(of);
      return std::distance(std::istream_iterator<std::string>(words), {});
    };
    int grains = 0;
    std::ptrdiff_t columns = 0;
    for (int i = 0; i < count; ++i) {
      ASSERT_TRUE(std::getline(text, line));
      const bool grain = line.starts_with("grains ");
      grains += grain;
      EXPECT_EQ(line.find("0.0025") != line.npos || !grain, true) << line;  // its radius, m
      if (i == 0) columns = fields(line);
      EXPECT_EQ(fields(line), columns) << line;
    }
    EXPECT_EQ(grains, 40);
    ++frames;
  }
  EXPECT_EQ(frames, 3);

  ASSERT_EQ(bedload("convert out/grains.vtkhdf --to lammps --out grains.dump").code, 0);
  const std::string dump = content_of(dir_ / "grains.dump");
  EXPECT_NE(dump.find("ITEM: NUMBER OF ATOMS\n40\n"), std::string::npos);
  EXPECT_NE(dump.find("ITEM: ATOMS id type x y z vx vy vz"), std::string::npos) << dump.substr(0, 400);
  EXPECT_NE(dump.find("\n40 2 "), std::string::npos);
}

}  // namespace
}  // namespace bedload::test

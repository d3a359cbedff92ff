// Free bodies as a case gives them.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support.hpp"

namespace bedload::test {
namespace {

std::string with_body(
    const std::string& free,
    const std::string& body = "shape = \"box\"\nmin = [0.1, 0.02, 0.12]\nmax = [0.14, 0.06, 0.14]\n") {
  return changed("[grain]\n",
                 "[[wall.body]]\nname = \"raft\"\n" + body + "[wall.body.free]\n" + free + "[grain]\n");
}

TEST(FreeBodyCase, TakesMassFromTheShapeAndMaterialFromTheGrains) {
  const Config c = read(with_body("density = 500\n"), {"grain.mu=0.45"});
  const FreeConfig& f = c.wall.bodies[1].free;
  ASSERT_TRUE(f.present);
  EXPECT_FALSE(c.wall.bodies[0].free.present);
  EXPECT_NEAR(f.solid.mass, 500 * 0.04 * 0.04 * 0.02, 1e-15);
  EXPECT_NEAR(f.solid.centre.z, 0.13, 1e-15);
  EXPECT_NEAR(f.solid.inertia[2], f.solid.mass * 0.0032 / 12, 1e-15);
  EXPECT_EQ(f.mu, 0.45);
  EXPECT_EQ(f.E, 1e8);
  EXPECT_NEAR(f.contact_spacing, 0.005, 1e-15);
  EXPECT_TRUE(c.wall.bodies[1].moves());
  EXPECT_EQ(c.out.bodies, "moving");
}

TEST(FreeBodyCase, ReadsBackAsResolved) {
  const Config c =
      read(with_body("mass = 0.1\nturn = \"axis\"\nmove = \"none\"\naxis = [0, 3, 4]\n"
                     "point = [0.1, 0.02, 0.13]\nspin = [0, 3, 4]\nmu = 0\nfluid = false\n"
                     "[[wall.body.free.contact]]\ncentre = [0.1, 0.03, 0.13]\nradius = 0.002\n"));
  const FreeConfig& f = c.wall.bodies[1].free;
  EXPECT_EQ(f.axis, Vec3d(0, 0.6, 0.8));
  EXPECT_EQ(f.mu, 0);
  ASSERT_EQ(f.balls.size(), 1u);
  Config again = read(resolved_toml(c));
  EXPECT_EQ(again.wall, c.wall);
}

TEST(FreeBodyCase, NeedsNeitherFluidNorGrains) {
  const Config c = read(
      "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[[wall.body]]\nname = \"a\"\nshape = \"box\"\n"
      "min = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\nfree = { density = 100 }\n[time]\nend = 1\n[out]\nevery = "
      "1\n");
  EXPECT_EQ(c.wall.free_bodies(), 1);
}

const std::string kRock =
    "[[shape]]\nname = \"rock\"\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [0.02, 0.01, "
    "0.01]\n[[wall.body]]\nname = "
    "\"stone\"\nshape = \"rock\"\n[wall.body.free]\ndensity = 500\n[wall.body.free.scatter]\ncount = 12\nmin "
    "= "
    "[0.06, 0, 0.1]\nmax = [0.2, 0.1, 0.2]\n";

TEST(FreeBodyCase, ScatteredBodiesLieApartInTheirBox) {
  const Config c = read(changed("[grain]\n", kRock + "gap = 0.002\n[grain]\n"));
  ASSERT_EQ(c.wall.bodies.size(), 13u);
  EXPECT_EQ(c.wall.free_bodies(), 12);
  const double across = std::sqrt(0.02 * 0.02 + 2 * 0.01 * 0.01);
  std::set<std::string> names;
  for (std::size_t i = 1; i <= 12; ++i) {
    const WallBody& body = c.wall.bodies[i];
    names.insert(body.name);
    EXPECT_FALSE(body.free.scatter.present);
    EXPECT_NEAR(body.free.solid.mass, 500 * 0.02 * 0.01 * 0.01, 1e-15);
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(body.min[k], Vec3d(0.06, 0, 0.1)[k]);
      EXPECT_LE(body.max[k], Vec3d(0.2, 0.1, 0.2)[k]);
    }
    for (std::size_t j = 1; j < i; ++j) {
      const Vec3d apart = body.free.solid.centre - c.wall.bodies[j].free.solid.centre;
      EXPECT_GE(norm(apart), across + 0.002);
      EXPECT_NE(body.free.solid.inertia, c.wall.bodies[j].free.solid.inertia)
          << "each lies in its own direction";
    }
  }
  EXPECT_EQ(names.size(), 12u);
  EXPECT_TRUE(names.contains("stone_1") && names.contains("stone_12"));
  EXPECT_EQ(read(changed("[grain]\n", kRock + "gap = 0.002\n[grain]\n")).wall, c.wall);
  EXPECT_NE(read(changed("[grain]\n", kRock + "gap = 0.002\nseed = 2\n[grain]\n")).wall, c.wall);
  Config again = read(resolved_toml(c));
  EXPECT_EQ(again.wall, c.wall);
  const Config straight = read(changed("[grain]\n", kRock + "turned = false\n[grain]\n"));
  EXPECT_NEAR(straight.wall.bodies[5].max.x - straight.wall.bodies[5].min.x, 0.02, 1e-12);
}

TEST(FreeBodyCase, ScatteredBodiesNeedRoomAndAShape) {
  const auto error = [](const std::string& from, const std::string& to) {
    std::string rock = kRock;
    rock.replace(rock.find(from), from.size(), to);
    return error_of(changed("[grain]\n", rock + "[grain]\n"));
  };
  EXPECT_NE(error("count = 12", "count = 500")
                .find("wall.body.free.scatter.count = 500 must fit into the box at random"),
            std::string::npos);
  EXPECT_NE(error("0.2, 0.1, 0.2", "0.07, 0.1, 0.2").find("must fit into the box at random: 0 did"),
            std::string::npos);
  EXPECT_NE(error("0.2, 0.1, 0.2", "0.05, 0.1, 0.2").find("scatter.max must exceed min along every axis"),
            std::string::npos);
  EXPECT_NE(error("density = 500", "density = 500\ncentre_of_mass = [0, 0, 0]")
                .find("free.centre_of_mass must be left out with free.scatter"),
            std::string::npos);
  EXPECT_NE(error("shape = \"rock\"", "shape = \"box\"\nmin = [0, 0, 0]\nmax = [0.01, 0.01, 0.01]")
                .find("wall.body.shape = \"box\" must be the name of a [[shape]] with free.scatter"),
            std::string::npos);
}

struct Wrong {
  const char* free;
  const char* message;
};

TEST(FreeBodyCase, ErrorsAreOneSentence) {
  for (const Wrong& w : {
           Wrong{"spin = [0, 0, 1]\n",
                 "dam.toml:20: wall.body.free must have exactly one of density and mass"},
           {"mass = 1\ndensity = 2\n",
            "dam.toml:20: wall.body.free must have exactly one of density and mass"},
           {"density = -3\n", "dam.toml:21: wall.body.free.density = -3 must be > 0"},
           {"density = 3\ninertia = [1, 2]\n",
            "dam.toml:22: wall.body.free.inertia = [1, 2] must hold 6 numbers"},
           {"density = 3\ninertia = [1, 1, 3, 0, 0, 0]\n",
            "dam.toml:22: wall.body.free.inertia = [1, 1, 3, 0, 0, 0] must be of a solid: principal moments "
            "above "
            "0, none above the sum of the other two"},
           {"density = 3\nturn = \"axis\"\n",
            "dam.toml:20: wall.body.free.axis must be given (direction of the axis of move and turn)"},
           {"density = 3\nturn = \"axis\"\naxis = [0, 0, 0]\n",
            "dam.toml:23: wall.body.free.axis = [0, 0, 0] must not be zero"},
           {"density = 3\npoint = [0, 0, 0]\n",
            "dam.toml:22: wall.body.free.point = [0, 0, 0] is not used by the chosen options; "
            "remove it"},
           {"density = 3\nmove = \"up\"\n",
            "dam.toml:22: wall.body.free.move = \"up\" must be one of all, plane, axis, none"},
           {"density = 3\n[wall.body.motion]\nkind = \"velocity\"\nvelocity = [1, 0, 0]\n",
            "dam.toml:20: wall.body \"raft\" must have only one of motion and free"},
       })
    EXPECT_EQ(error_of(with_body(w.free)), w.message);
  EXPECT_EQ(
      error_of(with_body("density = 3\n", "shape = \"tank\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\n")),
      "dam.toml:20: wall.body.free needs mass, centre_of_mass and inertia; shape = \"tank\" is not closed, "
      "so "
      "they do not follow from it");
  EXPECT_EQ(
      error_of(with_body("density = 3\n", "shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n")),
      "dam.toml:17: wall.body.shape = \"plane\" must not move freely; it has no end");
}

TEST(RigidGroupCase, ReadsBackAsResolvedAndSaysWhatIsWrong) {
  const auto rigid = [](const std::string& keys) {
    return changed("[time]\n", "[grain.fill.rigid]\n" + keys + "[time]\n");
  };
  const Config c = read(rigid("move = \"axis\"\nturn = \"none\"\naxis = [0, 0, 2]\n"));
  ASSERT_EQ(c.grain.rigid_fills(), std::vector<int>{0});
  EXPECT_EQ(c.grain.fills[0].rigid.axis, Vec3d(0, 0, 1));
  EXPECT_EQ(read(resolved_toml(c)).grain, c.grain);
  EXPECT_TRUE(read(rigid("")).grain.fills[0].rigid.present);
  EXPECT_NE(error_of(rigid("turn = \"axis\"\n")).find("grain.fill.rigid.axis must be given"),
            std::string::npos);
  EXPECT_NE(error_of(rigid("") + "[[outlet]]\nname = \"end\"\nmin = [0, 0, 0]\nmax = [0.01, 0.1, 0.1]\n")
                .find("outlet.phase = \"both\" must be \"fluid\" where grains form rigid groups"),
            std::string::npos);
}

}  // namespace
}  // namespace bedload::test

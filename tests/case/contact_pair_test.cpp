// Pairs of materials.

#include <gtest/gtest.h>

#include <cmath>

#include "bedload/case/materials.hpp"
#include "support.hpp"

namespace bedload::test {
namespace {

/// The case with steel and rubber beside the grains of [grain], and more tables.
std::string with(const std::string& more) {
  return changed("[time]\n",
                 "[[grain.material]]\nname = \"steel\"\nmu = 0.5\nmu_r = 0.03\ne = 0.5\n"
                 "[[grain.material]]\nname = \"rubber\"\n" +
                     more + "[time]\n");
}
std::string pair(const std::string& of, const std::string& keys) {
  return "[[contact.pair]]\nof = " + of + "\n" + keys;
}

TEST(ContactPairs, ComeBeforeTheWallAndTheMean) {
  Config c = read(with(pair("[\"rubber\", \"steel\"]", "mu = 0.7\n") +
                       pair("[\"grain\", \"tank\"]", "mu_r = 0.2\ne = 0.4\n")));
  c.wall.bodies[0].mu = 0.6, c.wall.bodies[0].mu_r = 0.3;
  const auto all = c.grain.all_materials();
  const GrainMaterial &own = all[0], &steel = all[1], &rubber = all[2];
  const auto is = [](const SurfacePair& s, double mu, double mu_r, double e) {
    EXPECT_DOUBLE_EQ(s.mu, mu);
    EXPECT_DOUBLE_EQ(s.mu_r, mu_r);
    EXPECT_DOUBLE_EQ(s.e, e);
  };
  is(surfaces(own, own, c.contact), 0.3, 0.01, 0.9);
  is(surfaces(own, steel, c.contact), 0.4, 0.02, 0.7);
  is(surfaces(steel, rubber, c.contact), 0.7, 0.02, 0.7);
  is(surfaces(rubber, steel, c.contact), 0.7, 0.02, 0.7);
  const auto on_wall = [&](const GrainMaterial& m) {
    return surfaces(m, c.wall.bodies[0], c.grain, c.contact);
  };
  is(on_wall(steel), 0.6, 0.3, 0.5);
  is(on_wall(own), 0.6, 0.2, 0.4);
  c.wall.bodies[0].material = "rubber";
  is(on_wall(steel), 0.7, 0.3, 0.7);
  is(on_wall(own), 0.6, 0.2, 0.4);
  EXPECT_TRUE(read(resolved_toml(c)) == c) << resolved_toml(c);
}

TEST(ContactPairs, AreOfTwoThatMeet) {
  const std::string of = "dam.toml:29: contact.pair.of = ";
  const auto why = [&](const std::string& names, const std::string& keys = "mu = 0.1\n") {
    return error_of(with(pair(names, keys)));
  };
  EXPECT_EQ(why("[\"steel\", \"lead\"]"),
            of + "[\"steel\", \"lead\"] must name materials of grains, or one and a wall.body that stops "
                 "grains: grain, rubber, steel, tank");
  EXPECT_EQ(why("[\"tank\", \"tank\"]"),
            of + "[\"tank\", \"tank\"] must name at least one material of grains, not two wall bodies");
  EXPECT_EQ(why("[\"steel\"]"), of + "[\"steel\"] must be two names");
  EXPECT_EQ(why("[\"steel\", \"tank\"]", ""), of + "[\"steel\", \"tank\"] must come with mu, mu_r or e");
  EXPECT_EQ(why("[\"steel\", \"tank\"]", "e = 1.5\n"),
            "dam.toml:30: contact.pair.e = 1.5 must be within 0.05..1; give a fraction, not percent?");
  EXPECT_EQ(
      error_of(with(pair("[\"steel\", \"tank\"]", "mu = 0\n") + pair("[\"tank\", \"steel\"]", "e = 0.5\n"))),
      "dam.toml:32: contact.pair.of = [\"tank\", \"steel\"] must differ from other pairs'");
  EXPECT_EQ(
      error_of(with("[[grain.material]]\nname = \"tank\"\n" + pair("[\"steel\", \"tank\"]", "mu = 0\n"))),
      "dam.toml:31: contact.pair.of = [\"steel\", \"tank\"] must name one thing each; there is more than one "
      "\"tank\"");
  EXPECT_EQ(error_of(changed(
                "[grain]\nd = 0.002\n[[grain.fill]]\nmin = [0, 0, 0]\nmax = [0.05, 0.1, 0.1]\ncount = 500\n",
                pair("[\"a\", \"b\"]", "mu = 1\n"))),
            "dam.toml:16: contact.pair.of = [\"a\", \"b\"] must be left out without [grain]");
}

}  // namespace
}  // namespace bedload::test

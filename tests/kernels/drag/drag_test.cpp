#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "bedload/parallel/loops.hpp"
#include "kernels/drag/registry.hpp"
#include "src/coupling/drag_table.hpp"
#include "tests/support/tolerance.hpp"

namespace BL_SOLVER {
namespace {

struct Row {
  std::string law;
  double eps, d, rho, mu, w, K;
};

std::vector<Row> drag_table() {
  std::ifstream file(std::filesystem::path(__FILE__).parent_path() / "drag_table.csv");
  std::vector<Row> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#' || line.rfind("law,", 0) == 0) continue;
    for (char& c : line)
      if (c == ',') c = ' ';
    std::istringstream in(line);
    Row r;
    in >> r.law >> r.eps >> r.d >> r.rho >> r.mu >> r.w >> r.K;
    rows.push_back(r);
  }
  return rows;
}

struct Flow {
  Real eps, d, rho, mu, w;
};

template <class Law>
struct EvaluatePass {
  Law law;
  Span<const Flow> flow;
  Span<Real> K;
  BL_HD void operator()(Index i) const {
    const Flow f = flow[i];
    K[i] = law.K(f.eps, f.d, f.rho, f.mu, f.w);
  }
};

/// K where the solver computes it.
std::vector<Real> evaluate(const std::string& law, const std::vector<Flow>& flows) {
  Buffer<Flow> in;
  in.assign(flows);
  Buffer<Real> K(flows.size());
  with_drag_law(law, [&](auto l) {
    for_each({0, Index(flows.size())}, EvaluatePass<decltype(l)>{l, in, K});
  });
  return K.to_host();
}

double evaluate(const std::string& law, double eps, double d, double rho, double mu, double w) {
  return evaluate(law, {{Real(eps), Real(d), Real(rho), Real(mu), Real(w)}})[0];
}

/// Speed (m/s) at which drag carries the weight in the fluid of a lone grain.
double terminal_speed(const std::string& law, double d, double rho_s, double rho, double mu) {
  const double weight = (rho_s - rho) * 9.81 * M_PI / 6 * d * d * d;
  double lo = 0, hi = 100;
  for (int k = 0; k < 60; ++k) {
    const double w = (lo + hi) / 2;
    (evaluate(law, 1, d, rho, mu, w) * w < weight ? lo : hi) = w;
  }
  return (lo + hi) / 2;
}

TEST(SmallDragLaws, MatchAnIndependentTable) {
  const auto rows = drag_table();
  std::map<std::string, int> rows_of;
  for (const Row& row : rows) ++rows_of[row.law];
  for (const auto& law : kNames<DragLaw>)  // "table" has no formula
    if (law.value != DragLaw::table) {
      EXPECT_EQ(rows_of[std::string(law.name)], 3 * 2 * 11) << law.name << ": see make_drag_table.py";
    }
  const double tolerance_of_K = tolerance(1e-12, 1e-6, 1e-5);
  for (std::size_t first = 0, last; first < rows.size(); first = last) {
    std::vector<Flow> flows;
    for (last = first; last < rows.size() && rows[last].law == rows[first].law; ++last) {
      const Row& r = rows[last];
      flows.push_back({Real(r.eps), Real(r.d), Real(r.rho), Real(r.mu), Real(r.w)});
    }
    const auto K = evaluate(rows[first].law, flows);
    for (std::size_t i = first; i < last; ++i) {
      ASSERT_TRUE(std::isfinite(K[i - first]));
      EXPECT_NEAR(K[i - first], rows[i].K, tolerance_of_K * rows[i].K)
          << rows[i].law << " eps " << rows[i].eps << " d " << rows[i].d << " w " << rows[i].w;
    }
  }
}

TEST(DragLaws, GidaspowJumpsWhereErgunMeetsWenYu) {
  const double d = 1e-3, rho = 1000, mu = 1e-3, w = 1000 * mu / (rho * d * 0.8);
  const Real above = std::nextafter(Real(0.8), Real(1));
  const double dense = evaluate("gidaspow", 0.8, d, rho, mu, w);
  const double dilute = evaluate("gidaspow", above, d, rho, mu, w);
  EXPECT_NEAR(dense / dilute, 3.732, 3.732e-3);
}

TEST(DragLaws, GidaspowBlendPassesSmoothlyBetweenThem) {
  const double d = 1e-3, rho = 1000, mu = 1e-3, w = 1000 * mu / (rho * d * 0.8);
  const double dense = evaluate("ergun", 0.8, d, rho, mu, w);
  const double dilute = evaluate("wen_yu", 0.8, d, rho, mu, w);
  EXPECT_NEAR(evaluate("gidaspow_blend", 0.8, d, rho, mu, w), 0.5 * (dense + dilute), 1e-3 * dense);
  const double step = 1e-5;  // of the porosity: the blend moves by 262.5/pi times as much of the jump
  const double move = evaluate("gidaspow_blend", 0.8 + step, d, rho, mu, w) -
                      evaluate("gidaspow_blend", 0.8 - step, d, rho, mu, w);
  EXPECT_LT(std::fabs(move), 2.1 * step * 262.5 / M_PI * std::fabs(dense - dilute));
  EXPECT_NEAR(evaluate("gidaspow_blend", 0.4, d, rho, mu, w), evaluate("ergun", 0.4, d, rho, mu, w),
              5e-3 * evaluate("wen_yu", 0.4, d, rho, mu, w));
}

TEST(DragLaws, SmallGrainsInWaterFallAtTheKnownSpeeds) {
  const double d = 1e-4, rho_s = 2500, rho = 1000, mu = 8.9e-4;
  EXPECT_NEAR(terminal_speed("stokes", d, rho_s, rho, mu), 9.185e-3, 9.185e-6);
  EXPECT_NEAR(terminal_speed("schiller_naumann", d, rho_s, rho, mu), 8.057e-3, 8.057e-6);
  EXPECT_NEAR(terminal_speed("di_felice", d, rho_s, rho, mu), 7.609e-3, 7.609e-6);
}

TEST(DragLaws, ALargeGrainFallsInTheNewtonRegime) {
  // d = 0.1 m, density ratio 2.7, mu = 0.01 Pa s: Re = 2.2e4, C_D = 0.44
  EXPECT_NEAR(terminal_speed("schiller_naumann", 0.1, 2700, 1000, 0.01), 2.248, 2.248e-3);
}

/// Drag over Stokes drag of a law at a porosity and a Reynolds number.
double factor(const std::string& law, double eps, double Re) {
  return evaluate(law, eps, 1, 1, 1, Re / eps) / (3 * M_PI);
}

TEST(SmallDragLaws, ATableIsTheLawThatItWasMadeOf) {
  DragTable table;
  for (int k = 0; k <= 15; ++k) table.porosity.push_back(0.25 + 0.05 * k);
  table.reynolds.push_back(0);
  for (int k = 0; k <= 64; ++k) table.reynolds.push_back(1e-3 * std::pow(10, k / 8.0));
  for (const double eps : table.porosity)
    for (const double Re : table.reynolds) table.factor.push_back(factor("di_felice", eps, Re));
  const TableOfDrag made(table);

  std::vector<Flow> flows;
  for (const double eps : {0.2, 0.4, 0.4321, 0.98, 1.0})
    for (const double Re : {0.0, 0.03, 1.0, 77.0, 5.4e4, 1e6})
      flows.push_back({Real(eps), 1, 1, 1, Real(Re / eps)});
  Buffer<Flow> in;
  in.assign(flows);
  Buffer<Real> K(flows.size());
  for_each({0, Index(flows.size())}, EvaluatePass<Tabulated>{made.on_device(), in, K});
  const auto found = K.to_host();
  for (std::size_t i = 0; i < flows.size(); ++i) {
    const Flow& f = flows[i];
    const double eps = std::max(double(f.eps), 0.25), Re = f.eps * f.w;  // its first porosity stands below it
    const double expected = 3 * M_PI * factor("di_felice", eps, Re);
    const double bound =
        Re > 1e5 ? 0.03 : 0.006;  // the power that goes on is not yet that far from creeping flow
    EXPECT_NEAR(found[i], expected, bound * expected) << "eps " << f.eps << " Re " << Re;
    EXPECT_NEAR(made.on_host().K(f.eps, f.d, f.rho, f.mu, f.w), found[i], 1e-4 * expected);
  }
}

TEST(SmallDragLaws, ATableOfOneRowHoldsAtAnyPorosity) {
  const TableOfDrag table(DragTable{{0.5}, {0, 9}, {2, 20}});
  const Tabulated law = table.on_host();
  const double stokes = 3 * M_PI;
  EXPECT_NEAR(law.K(1, 1, 1, 1, 0), 2 * stokes, 1e-4);
  EXPECT_NEAR(law.K(Real(0.4), 1, 1, 1, Real(9 / 0.4)), 20 * stokes, 1e-3);
  EXPECT_NEAR(law.K(1, 1, 1, 1, 99), 200 * stokes,
              1e-2);  // 1 + Re ten times, so the factor ten times, once more
}

TEST(DragLaws, AnUnknownNameIsAnErrorThatListsTheLaws) {
  try {
    with_drag_law("gidaspaw", [](auto) { FAIL(); });
    FAIL();
  } catch (const CaseError& e) {
    EXPECT_EQ(std::string(e.what()), "\"gidaspaw\" must be one of " + names_of<DragLaw>());
  }
}

}  // namespace
}  // namespace BL_SOLVER

#pragma once
// The drag laws that a case may name. A new law needs an include and an entry in the list.

#include <algorithm>

#include "kernels/drag/di_felice.hpp"
#include "kernels/drag/ergun.hpp"
#include "kernels/drag/gidaspow.hpp"
#include "kernels/drag/gidaspow_blend.hpp"
#include "kernels/drag/schiller_naumann.hpp"
#include "kernels/drag/stokes.hpp"
#include "kernels/drag/tabulated.hpp"
#include "kernels/drag/wen_yu.hpp"

namespace BL_SOLVER {

template <class... Laws>
struct DragLawList {
  static constexpr bool holds(DragLaw law) { return ((law == Laws::law) || ...); }
  /// f(law) for the law of that name.
  template <class F>
  static void with(DragLaw law, const Tabulated& table, F& f) {
    (void)((law == Laws::law && (f(made<Laws>(table)), true)) || ...);
  }

 private:
  template <class Law>
  static Law made([[maybe_unused]] const Tabulated& table) {
    if constexpr (std::is_same_v<Law, Tabulated>)
      return table;
    else
      return {};
  }
};

using DragLaws =
    DragLawList<Stokes, SchillerNaumann, WenYu, Ergun, Gidaspow, GidaspowBlend, DiFelice, Tabulated>;

static_assert(std::all_of(kNames<DragLaw>.begin(), kNames<DragLaw>.end(),
                          [](const auto& row) { return DragLaws::holds(row.value); }),
              "a drag law that a case may name is missing in DragLaws");

/// f(law) with the drag law of that name, or `table`; chosen once, on the host. Throws CaseError for an
/// unknown name.
template <class F>
void with_drag_law(Chosen<DragLaw> name, F&& f, const Tabulated& table = {}) {
  DragLaws::with(name, table, f);
}

}  // namespace BL_SOLVER

#pragma once
// The drag laws that a case may name. A new law is an include and its name in the list.

#include <string>

#include "bedload/core/error.hpp"
#include "kernels/drag/di_felice.hpp"
#include "kernels/drag/ergun.hpp"
#include "kernels/drag/gidaspow.hpp"
#include "kernels/drag/gidaspow_blend.hpp"
#include "kernels/drag/schiller_naumann.hpp"
#include "kernels/drag/stokes.hpp"
#include "kernels/drag/wen_yu.hpp"

namespace bedload::inline BL_VARIANT {

template <class... Laws>
struct DragChoices {
  /// f(law) for the law called `name`; false if there is none.
  template <class F>
  static bool with(const std::string& name, F& f) {
    return ((name == Laws::name && (f(Laws{}), true)) || ...);
  }
  /// "stokes, schiller_naumann, ..."
  static std::string names() {
    std::string all;
    ((all += (all.empty() ? "" : ", ") + std::string(Laws::name)), ...);
    return all;
  }
};

using DragLaws = DragChoices<Stokes, SchillerNaumann, WenYu, Ergun, Gidaspow, GidaspowBlend, DiFelice>;

/// f(law) with the drag law called `name`: the choice is made here, once, on the host.
/// Throws CaseError for an unknown name.
template <class F>
void with_drag_law(const std::string& name, F&& f) {
  if (!DragLaws::with(name, f))
    throw CaseError("drag.law = " + name + ": must be one of " + DragLaws::names());
}

}  // namespace bedload::inline BL_VARIANT

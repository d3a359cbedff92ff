#pragma once
// A formula of a case file, compiled: steps for a machine with a stack, the same on host and device.

#include <cmath>
#include <cstdint>

#include "bedload/core/vec.hpp"

namespace bedload {

/// By how many values they take off the stack; each puts one on it.
enum class FormulaOp : std::int32_t {
  number,
  variable,  // none
  negative,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  asinh,
  acosh,
  atanh,  // one
  exp,
  ln,
  log2,
  log10,
  sqrt,
  rint,
  sign,
  abs,
  add,
  subtract,
  multiply,
  divide,
  power,
  atan2,
  min,
  max,  // two
  less,
  more,
  at_most,
  at_least,
  equal,
  unequal,
  both,
  either,
  choose  // three: a ? b : c
};

BL_HD constexpr int operands(FormulaOp op) {
  return op < FormulaOp::negative ? 0 : op < FormulaOp::add ? 1 : op < FormulaOp::choose ? 2 : 3;
}

struct FormulaStep {
  FormulaOp op = FormulaOp::number;
  std::int32_t variable = 0;  ///< 0 to 3: x, y, z, t, whatever the formula calls them
  double number = 0;
};

/// A formula as Formula has read it. Both sides of a choice are worked out.
struct FormulaCode {
  static constexpr int kDepth = 64;  ///< of the stack

  const FormulaStep* steps = nullptr;
  int count = 0;

  BL_HD double operator()(const Vec3d& x, double t) const {
    double stack[kDepth];
    double* top = stack;
    for (int k = 0; k < count; ++k) {
      const FormulaStep& step = steps[k];
      switch (operands(step.op)) {
        case 0:
          *top = step.op == FormulaOp::number ? step.number : step.variable == 3 ? t : x[step.variable];
          break;
        case 1:
          --top;
          *top = of(step.op, *top);
          break;
        case 2:
          top -= 2;
          *top = of(step.op, top[0], top[1]);
          break;
        default:
          top -= 3;
          *top = top[0] != 0 ? top[1] : top[2];
      }
      ++top;
    }
    return stack[0];
  }

 private:
  BL_HD static double of(FormulaOp op, double a) {
    switch (op) {
      case FormulaOp::negative:
        return -a;
      case FormulaOp::sin:
        return std::sin(a);
      case FormulaOp::cos:
        return std::cos(a);
      case FormulaOp::tan:
        return std::tan(a);
      case FormulaOp::asin:
        return std::asin(a);
      case FormulaOp::acos:
        return std::acos(a);
      case FormulaOp::atan:
        return std::atan(a);
      case FormulaOp::sinh:
        return std::sinh(a);
      case FormulaOp::cosh:
        return std::cosh(a);
      case FormulaOp::tanh:
        return std::tanh(a);
      case FormulaOp::asinh:
        return std::asinh(a);
      case FormulaOp::acosh:
        return std::acosh(a);
      case FormulaOp::atanh:
        return std::atanh(a);
      case FormulaOp::exp:
        return std::exp(a);
      case FormulaOp::ln:
        return std::log(a);
      case FormulaOp::log2:
        return std::log2(a);
      case FormulaOp::log10:
        return std::log10(a);
      case FormulaOp::sqrt:
        return std::sqrt(a);
      case FormulaOp::rint:
        return std::floor(a + 0.5);
      case FormulaOp::sign:
        return a < 0 ? -1 : a > 0 ? 1 : 0;
      case FormulaOp::abs:
        return std::fabs(a);
      default:
        return 0;
    }
  }
  BL_HD static double of(FormulaOp op, double a, double b) {
    switch (op) {
      case FormulaOp::add:
        return a + b;
      case FormulaOp::subtract:
        return a - b;
      case FormulaOp::multiply:
        return a * b;
      case FormulaOp::divide:
        return a / b;
      case FormulaOp::power:
        return b == 2 ? a * a : std::pow(a, b);
      case FormulaOp::atan2:
        return std::atan2(a, b);
      case FormulaOp::min:
        return b < a ? b : a;
      case FormulaOp::max:
        return a < b ? b : a;
      case FormulaOp::less:
        return a < b;
      case FormulaOp::more:
        return a > b;
      case FormulaOp::at_most:
        return a <= b;
      case FormulaOp::at_least:
        return a >= b;
      case FormulaOp::equal:
        return a == b;
      case FormulaOp::unequal:
        return a != b;
      case FormulaOp::both:
        return a != 0 && b != 0;
      case FormulaOp::either:
        return a != 0 || b != 0;
      default:
        return 0;
    }
  }
};

}  // namespace bedload

#include "bedload/case/formula.hpp"

#include <muParser.h>

#include <numbers>
#include <string_view>

#include "bedload/core/error.hpp"

namespace bedload {

struct Formula::Impl {
  double at[4] = {};
  mu::Parser parser;
};

Formula::Formula(const std::string& text, std::string_view variables) : impl_(std::make_unique<Impl>()) {
  try {
    mu::Parser& p = impl_->parser;
    p.DefineConst("pi", std::numbers::pi);
    p.DefineConst("e", std::numbers::e);
    for (std::size_t k = 0; k < variables.size(); ++k)
      p.DefineVar(std::string(1, variables[k]), &impl_->at[k]);
    p.SetExpr(text);
    int values = 0;
    p.Eval(values);  // muParser reads the text only now
    if (values != 1)
      throw CaseError("it makes " + std::to_string(values) + " values; is a decimal comma meant as a point?");
    for (std::size_t at = text.find('='); at != text.npos; at = text.find('=', at + 1)) {
      const bool compares = at + 1 < text.size() && text[at + 1] == '=';
      if (compares)
        ++at;
      else if (at == 0 || std::string_view("<>!").find(text[at - 1]) == std::string_view::npos)
        throw CaseError("= assigns; == compares");
    }
  } catch (const mu::Parser::exception_type& error) {
    std::string reason = error.GetMsg();
    while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
    throw CaseError(reason);
  }
}

Formula::Formula(Formula&&) noexcept = default;
Formula::~Formula() = default;

double Formula::operator()(const Vec3d& x) const { return (*this)(x, impl_->at[3]); }

double Formula::operator()(const Vec3d& x, double t) const {
  for (int k = 0; k < 3; ++k) impl_->at[k] = x[k];
  impl_->at[3] = t;
  return impl_->parser.Eval();
}

bool Formula::uses(char variable) const {
  return impl_->parser.GetUsedVar().contains(std::string(1, variable));
}

}  // namespace bedload

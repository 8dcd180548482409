#include "fem_reference/elements/element.h"

#include <fmt/format.h>

#include "problem/system/input_error.h"

namespace springproof::fem {

Element element_named(const std::string& name) {
  if (name.size() == 2 && (name[0] == 'q' || name[0] == 'p') && (name[1] == '1' || name[1] == '2'))
    return {name[0] == 'p', name[1] - '0'};
  throw InputError(fmt::format("unknown element \"{}\" (allowed: q1, q2: hexahedra; p1, p2: tetrahedra)", name));
}

Form form_for(const Element& element, double poisson_ratio, bool small_strain) {
  if (element.tetrahedra && element.degree == 1) return Form::pointwise;
  // For Q1 the mixed form is equivalent to mean dilatation, for which conjugate gradients suffice up to larger
  // Poisson's ratios.
  const double limit = element.degree == 2 ? 0.4 : small_strain ? 0.4995 : 0.45;
  if (poisson_ratio > limit) return Form::mixed;
  return element.degree == 1 ? Form::mean_dilatation : Form::pointwise;
}

std::string describe(const Element& element, Form form) {
  if (element.tetrahedra && element.degree == 1) return "P1 displacement";
  if (element.tetrahedra) return form == Form::mixed ? "P2-P1 mixed" : "P2 displacement";
  if (element.degree == 1) return form == Form::mixed ? "Q1 B-bar as Q1-P0" : "Q1 B-bar";
  return form == Form::mixed ? "Q2-P1disc mixed" : "Q2 displacement";
}

}  // namespace springproof::fem

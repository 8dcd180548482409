#include "problem/exact_field.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace springproof {
namespace {

using std::numbers::pi;

/// amplitude * product over j of sin(k_j pi x_j + phase_j): derivatives scale it and shift its phases.
struct Term {
  double amplitude;  ///< [m]
  std::array<double, 3> k;
  std::array<double, 3> phase;
};

using Sum = std::vector<Term>;
using VectorField = std::array<Sum, 3>;

Sum derivative(Sum sum, int j) {
  for (Term& term : sum) {
    term.amplitude *= term.k[j] * pi;
    term.phase[j] += pi / 2;
  }
  return sum;
}

Sum difference(Sum a, const Sum& b) {
  for (Term term : b) {
    term.amplitude = -term.amplitude;
    a.push_back(term);
  }
  return a;
}

double value(const Sum& sum, const Vec3& x) {
  double total = 0;
  for (const Term& term : sum) {
    double product = term.amplitude;
    for (int j = 0; j < 3; ++j) product *= std::sin(term.k[j] * pi * x[j] + term.phase[j]);
    total += product;
  }
  return total;
}

VectorField curl(const VectorField& a) {
  VectorField u;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    u[i] = difference(derivative(a[k], j), derivative(a[j], k));
  }
  return u;
}

/// A field with the derivatives that its body force needs.
struct ExactField {
  const char* name;
  VectorField displacement;
  VectorField laplacian;
  VectorField gradient_of_divergence;
};

ExactField with_derivatives(const char* name, const VectorField& u) {
  ExactField field{name, u, {}, {}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Sum second = derivative(derivative(u[i], j), j), mixed = derivative(derivative(u[j], j), i);
      field.laplacian[i].insert(field.laplacian[i].end(), second.begin(), second.end());
      field.gradient_of_divergence[i].insert(field.gradient_of_divergence[i].end(), mixed.begin(), mixed.end());
    }
  return field;
}

const std::vector<ExactField>& fields() {
  static const VectorField waves = {{{{0.010, {1, 1, 1}, {0.4, 0.9, 0.2}}},
                                     {{-0.007, {1, 1, 1}, {1.1, 0.5, 0.7}}},
                                     {{0.005, {1, 1, 1}, {0.3, 1.3, 0.6}}}}};
  static const VectorField potential = {{{{0.002, {1, 1, 1}, {0.8, 0.3, 0.5}}},
                                         {{-0.003, {1, 1, 1}, {0.2, 0.6, 1.2}}},
                                         {{0.004, {1, 1, 1}, {0.5, 1.0, 0.4}}}}};
  static const std::vector<ExactField> all = {with_derivatives("trigonometric", waves),
                                              with_derivatives("solenoidal", curl(potential))};
  return all;
}

const ExactField& find(const std::string& name) {
  for (const ExactField& field : fields())
    if (field.name == name) return field;
  throw std::invalid_argument(
      fmt::format("there is no exact field '{}' (allowed: {})", name, fmt::join(exact_field_names(), ", ")));
}

Vec3 value(const VectorField& field, const Vec3& x) {
  return {value(field[0], x), value(field[1], x), value(field[2], x)};
}

}  // namespace

std::vector<std::string> exact_field_names() {
  std::vector<std::string> names;
  for (const ExactField& field : fields()) names.emplace_back(field.name);
  return names;
}

Vec3 exact_displacement(const std::string& field, const Vec3& X) { return value(find(field).displacement, X); }

Vec3 exact_body_force(const std::string& field, const Vec3& X, const IsotropicMaterial& material) {
  const double G = shear_modulus(material), lambda = lame_lambda(material);
  const ExactField& exact = find(field);
  return -(G * value(exact.laplacian, X) + (lambda + G) * value(exact.gradient_of_divergence, X));
}

}  // namespace springproof

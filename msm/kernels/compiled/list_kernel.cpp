// Springs in blocks of four from one node.  Four differences of padded vectors give four squared lengths by shuffles,
// their roots are computed in full registers, and each tension multiplies its own difference again: no transposes, and
// whole nodes are loaded and stored, so that two lanes may share a node.
#include "msm/kernels/compiled/all_kernels.h"
#include "msm/kernels/compiled/padded_nodes.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

template <class Real>
inline Wide<Real> inverse_roots(Wide<Real> squares) {
  Real values[4 * group<Real>];
  reinterpret_cast<Wide<Real>&>(values) = squares;
  for (int l = 0; l < 4 * group<Real>; l += lanes<Real>) store<Real>(inverse_root(load<Real>(values + l)), values + l);
  return reinterpret_cast<Wide<Real>&>(values);
}

/// Horizontal sums of the four vectors.
template <class V>
inline V sums(const V& a, const V& b, const V& c, const V& d) {
  const V ab = __builtin_shufflevector(a, b, 0, 4, 2, 6) + __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const V cd = __builtin_shufflevector(c, d, 0, 4, 2, 6) + __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return __builtin_shufflevector(ab, cd, 0, 1, 4, 5) + __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
}

/// Nodes and difference vectors of one group of blocks.
template <class Real>
struct Group {
  int i[group<Real>];
  const int* j;
  Four<Real> d[group<Real>][4];  // x_j - x_i

  inline Group(const ListPattern& p, long block, const Padded<Real>* x) : j(p.j + 4 * block) {
    for (int g = 0; g < group<Real>; ++g) {
      i[g] = p.i[block + g];
      const Four<Real> from = four(x, i[g]);
      for (int l = 0; l < 4; ++l) d[g][l] = four(x, j[4 * g + l]) - from;
    }
  }

  inline Wide<Real> squared_lengths() const {
    Four<Real> parts[group<Real>];
    for (int g = 0; g < group<Real>; ++g)
      parts[g] = sums<Four<Real>>(d[g][0] * d[g][0], d[g][1] * d[g][1], d[g][2] * d[g][2], d[g][3] * d[g][3]);
    return join<Real>(parts);
  }

  /// Dot products with one vector per entry.
  inline Wide<Real> along(const Padded<Real>* m) const {
    Four<Real> parts[group<Real>];
    for (int g = 0; g < group<Real>; ++g)
      parts[g] = sums<Four<Real>>(d[g][0] * four(m, 4 * g), d[g][1] * four(m, 4 * g + 1), d[g][2] * four(m, 4 * g + 2),
                                  d[g][3] * four(m, 4 * g + 3));
    return join<Real>(parts);
  }
};

/// f_i += s d, f_j -= s d.
template <class Real>
inline void scatter(const int* i, const int* j, const Four<Real> (&d)[group<Real>][4], const Wide<Real>& s,
                    Padded<Real>* f) {
  for (int g = 0; g < group<Real>; ++g) {
    const Four<Real> s0 = all<Real>(s[4 * g]), s1 = all<Real>(s[4 * g + 1]), s2 = all<Real>(s[4 * g + 2]),
                     s3 = all<Real>(s[4 * g + 3]);
    four(f, i[g]) += (s0 * d[g][0] + s1 * d[g][1]) + (s2 * d[g][2] + s3 * d[g][3]);
    four(f, j[4 * g]) -= s0 * d[g][0];
    four(f, j[4 * g + 1]) -= s1 * d[g][1];
    four(f, j[4 * g + 2]) -= s2 * d[g][2];
    four(f, j[4 * g + 3]) -= s3 * d[g][3];
  }
}

/// J_i += a_i e, J_j += a_j e.
template <class Real>
inline void add_inflow(const int* i, const int* j, const Wide<Real>& to_i, const Wide<Real>& to_j, Real* J) {
  for (int g = 0; g < group<Real>; ++g) {
    J[i[g]] += (to_i[4 * g] + to_i[4 * g + 1]) + (to_i[4 * g + 2] + to_i[4 * g + 3]);
    for (int l = 4 * g; l < 4 * g + 4; ++l) J[j[l]] += to_j[l];
  }
}

/// c_i J_i + c_j J_j.
template <class Real>
inline Wide<Real> dispersed(const int* i, const int* j, const ListDispersion<Real>& c, long e, const Real* J) {
  Wide<Real> at_i, at_j;
  for (int g = 0; g < group<Real>; ++g)
    for (int l = 4 * g; l < 4 * g + 4; ++l) {
      at_i[l] = J[i[g]];
      at_j[l] = J[j[l]];
    }
  return wide(c.c_i + e) * at_i + wide(c.c_j + e) * at_j;
}

template <class Real>
void spring_forces(const ListPattern& p, const ListSprings<Real>& springs, const Padded<Real>* x, Padded<Real>* f) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const Group<Real> at(p, b, x);
    const Wide<Real> s = wide(springs.k + 4 * b) - wide(springs.kL + 4 * b) * inverse_roots<Real>(at.squared_lengths());
    scatter<Real>(at.i, at.j, at.d, s, f);
  }
}

template <class Real>
void inflow(const ListPattern& p, const ListSprings<Real>& springs, const ListDispersion<Real>& dispersion,
            const Padded<Real>* x, Real* J, Real* inverse_length) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const Group<Real> at(p, b, x);
    const Wide<Real> square = at.squared_lengths(), inverse = inverse_roots<Real>(square);
    const Wide<Real> e = square * inverse - wide(springs.L + 4 * b);
    *reinterpret_cast<Wide<Real>*>(inverse_length + 4 * b) = inverse;
    add_inflow<Real>(at.i, at.j, wide(dispersion.a_i + 4 * b) * e, wide(dispersion.a_j + 4 * b) * e, J);
  }
}

template <class Real>
void dispersed_forces(const ListPattern& p, const ListSprings<Real>& springs, const ListDispersion<Real>& dispersion,
                      const Padded<Real>* x, const Real* J, const Real* inverse_length, Padded<Real>* f) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const Group<Real> at(p, b, x);
    const Wide<Real> added = dispersed<Real>(at.i, at.j, dispersion, 4 * b, J);
    const Wide<Real> s = wide(springs.k + 4 * b) + (added - wide(springs.kL + 4 * b)) * wide(inverse_length + 4 * b);
    scatter<Real>(at.i, at.j, at.d, s, f);
  }
}

template <bool forces_apart, class Real>
inline double step_nodes(const ListStep<Real>& s) {
  Four<Real> squares = all<Real>(0);
  for (long n = 0; n < s.nodes; ++n) {
    const int node = static_cast<int>(n);
    const Four<Real> given = four(s.external, node);
    const Four<Real> external = __builtin_shufflevector(given, all<Real>(0), 0, 1, 2, 4);
    Four<Real> sum = four(s.s, node) + external;
    if constexpr (forces_apart) {
      const Four<Real> f = four(s.f, node), force = f + external;
      squares += force * force;
      sum += f;
      four(s.f, node) = all<Real>(0);
    }
    four(s.x, node) += (s.dt * given[3]) * sum;
    four(s.s, node) = s.decay * sum;
  }
  return double(squares[0]) + double(squares[1]) + double(squares[2]);
}

template <class Real>
double step(const ListStep<Real>& s) {
  return s.f ? step_nodes<true>(s) : step_nodes<false>(s);
}

template <class Real>
void average(const CellAverages<Real>& a) {
  for (long c = 0; c < a.cells; ++c) {
    const int* corners = a.corners + 8 * c;
    Four<Real> v[8], sum[8];  // sum: 27 times the average, one axis after the other
    for (int n = 0; n < 8; ++n) sum[n] = v[n] = four(a.v, corners[n]);
    for (int axis = 1; axis <= 4; axis *= 2)
      for (int n = 0; n < 8; ++n) {
        if (n & axis) continue;
        const Four<Real> both = sum[n] + sum[n + axis];
        sum[n] += both;
        sum[n + axis] += both;
      }
    for (int n = 0; n < 8; ++n)
      four(a.x, corners[n]) += a.factors[c] * a.shares[corners[n]] * (v[n] - Real(1.0 / 27) * sum[n]);
  }
}

template <class Real>
void stiffness(const ListPattern& p, const Padded<Real>* m, const Padded<Real>* u, Padded<Real>* y) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const Group<Real> at(p, b, u);
    const Wide<Real> t = -at.along(m + 4 * b);
    scatter<Real>(at.i, at.j, reinterpret_cast<const Four<Real>(&)[group<Real>][4]>(m[4 * b]), t, y);
  }
}

template <class Real>
void linear_inflow(const ListPattern& p, const Padded<Real>* m, const ListDispersion<Real>& dispersion,
                   const Padded<Real>* u, Real* J, Real* kept) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const Group<Real> at(p, b, u);
    const Wide<Real> t = at.along(m + 4 * b);
    *reinterpret_cast<Wide<Real>*>(kept + 4 * b) = t;
    add_inflow<Real>(at.i, at.j, wide(dispersion.a_i + 4 * b) * t, wide(dispersion.a_j + 4 * b) * t, J);
  }
}

template <class Real>
void linear_forces(const ListPattern& p, const Padded<Real>* m, const ListDispersion<Real>& dispersion, const Real* J,
                   const Real* kept, Padded<Real>* y) {
  for (long b = 0; b < p.blocks; b += group<Real>) {
    const int *i = p.i + b, *j = p.j + 4 * b;
    const Wide<Real> t = -(wide(kept + 4 * b) + dispersed<Real>(i, j, dispersion, 4 * b, J));
    scatter<Real>(i, j, reinterpret_cast<const Four<Real>(&)[group<Real>][4]>(m[4 * b]), t, y);
  }
}

template <class Real>
void smooth(const ListSmoothing<Real>& s) {
  for (long n = 0; n < s.nodes; ++n) {
    const int node = static_cast<int>(n);
    const Four<Real> r = four(s.r, node) - four(s.y, node);
    const Four<Real> Dr =
        r[0] * four(s.inverse, 3 * node) + r[1] * four(s.inverse, 3 * node + 1) + r[2] * four(s.inverse, 3 * node + 2);
    const Four<Real> z = s.old_part * four(s.z, node) + s.new_part * Dr;
    four(s.r, node) = r;
    four(s.z, node) = z;
    four(s.x, node) += z;
    four(s.y, node) = all<Real>(0);
  }
}

}  // namespace

template <class Real>
ListKernels<Real> list_kernels() {
  return {.spring_forces = spring_forces<Real>,
          .inflow = inflow<Real>,
          .dispersed_forces = dispersed_forces<Real>,
          .step = step<Real>,
          .average = average<Real>,
          .stiffness = stiffness<Real>,
          .linear_inflow = linear_inflow<Real>,
          .linear_forces = linear_forces<Real>,
          .smooth = smooth<Real>};
}

template ListKernels<double> list_kernels();
template ListKernels<float> list_kernels();

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE

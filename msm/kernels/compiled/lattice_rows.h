// Rows and blocks of a lattice and the accumulation of forces on them.  For the lattice kernels only.
#pragma once

#include "msm/kernels/compiled/simd_math.h"
#include "msm/kernels/lattice_kernels.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {

template <class Real>
struct Row {
  const Real *x, *y, *z;
};
template <class Real>
struct ForceRow {
  Real *x, *y, *z;
};

/// Coefficients of the blocks of a row.
template <class Real>
struct Coefficients {
  const int* entry;
  const Real* table;
  const Real* of(int block) const { return table + entry[block]; }
};

template <class Real>
struct Force {
  Lanes<Real> x = 0, y = 0, z = 0;
};

template <class Real>
SPRINGPROOF_INLINE Lanes<Real> coefficient(const Real* entry, int number) {
  return load(entry + number * lanes<Real>);
}

constexpr double root_of(int n) { return n == 1 ? 1.0 : n == 2 ? 1.41421356237309504880 : 1.73205080756887729353; }

template <class Real>
Row<Real> row_of(const LatticeView<Real>& l, int y, int z) {
  const long at = z * l.plane + y * l.row;
  return {l.u[0] + at, l.u[1] + at, l.u[2] + at};
}

template <class Real>
Row<Real> velocities_of(const LatticeView<Real>& l, int y, int z) {
  const long at = z * l.plane + y * l.row;
  return {l.v[0] + at, l.v[1] + at, l.v[2] + at};
}

template <class Real>
SPRINGPROOF_INLINE void add(Force<Real>& f, const Lanes<Real>& t, const Lanes<Real>& x, const Lanes<Real>& y,
                            const Lanes<Real>& z) {
  f.x += t * x;
  f.y += t * y;
  f.z += t * z;
}
template <class Real>
SPRINGPROOF_INLINE void subtract(Force<Real>& f, const Lanes<Real>& t, const Lanes<Real>& x, const Lanes<Real>& y,
                                 const Lanes<Real>& z) {
  f.x -= t * x;
  f.y -= t * y;
  f.z -= t * z;
}

template <class Real>
SPRINGPROOF_INLINE void add_to(const ForceRow<Real>& row, long n, const Force<Real>& f) {
  store<Real>(load(row.x + n) + f.x, row.x + n);
  store<Real>(load(row.y + n) + f.y, row.y + n);
  store<Real>(load(row.z + n) + f.z, row.z + n);
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> shifted(const Force<Real>& before, const Force<Real>& f) {
  return {shift_in(before.x, f.x), shift_in(before.y, f.y), shift_in(before.z, f.z)};
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> sum(const Force<Real>& a, const Force<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Real>
SPRINGPROOF_INLINE Force<Real> difference(const Force<Real>& a, const Force<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

/// Inverse lengths of the springs that start from a row, computed by inflow(): direction by direction, l.row values
/// each.
template <class Real>
Real* inverse_lengths(const LatticeView<Real>& l, int y, int z) {
  return l.inverse_lengths + (long(z % l.kept_planes) * l.rows + y) * lattice_directions * l.row;
}

/// Adds the inflow of the springs of a plane's nodes to J and stores their inverse lengths.
template <class Real>
void inflow(const LatticeView<Real>& l, int z);

/// LatticeKernels::average.
template <class Real>
void average(const LatticeView<Real>& l, const LatticeAverage<Real>& a, int begin, int end);

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE

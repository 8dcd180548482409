// The average over the cells that a share of consistent mass takes (msm/dynamics/terms/mass_average.h), on a box of
// full cells.
#include "msm/kernels/compiled/lattice_rows.h"

namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE {
namespace {

/// to = before + 4 at + after, n values in whole vectors.
template <class Real>
void add_three(const Real* before, const Real* at, const Real* after, Real* to, long n) {
  for (long i = 0; i < n; i += lanes<Real>)
    store<Real>(load(before + i) + Real(4) * load(at + i) + load(after + i), to + i);
}

/// u += factor (v - average of v along a row), `line` six times six of the average across it.
template <class Real>
void correct_row(const LatticeAverage<Real>& a, const Real* line, const Real* v, Real* u) {
  const Real own = a.factor, other = -a.factor / 216;
  long n = 0;
  for (; n + lanes<Real> <= a.nodes; n += lanes<Real>)
    store<Real>(
        load(u + n) + own * load(v + n) + other * (load(line + n - 1) + Real(4) * load(line + n) + load(line + n + 1)),
        u + n);
  for (; n < a.nodes; ++n) u[n] += own * v[n] + other * (line[n - 1] + Real(4) * line[n] + line[n + 1]);
}

}  // namespace

/// One axis after the other; beyond an end of the box its mirror image, as an end has half of the mass.
template <class Real>
void average(const LatticeView<Real>& l, const LatticeAverage<Real>& a, int begin, int end) {
  const long width = long(l.row_blocks) * lanes<Real>, plane = width * l.rows;
  const auto mirrored = [](int i, int count) { return i < 0 ? -i : i < count ? i : 2 * (count - 1) - i; };
  Real* line = a.work + 3 * plane + lanes<Real>;
  for (int d = 0; d < 3; ++d) {
    const auto kept = [&](int z) { return a.work + (z + 3) % 3 * plane; };
    const auto across = [&](int z) {  // a plane averaged along y
      const Real* v = l.v[d] + mirrored(z, l.planes) * l.plane;
      for (int y = 0; y < l.rows; ++y)
        add_three<Real>(v + mirrored(y - 1, l.rows) * l.row, v + y * l.row, v + mirrored(y + 1, l.rows) * l.row,
                        kept(z) + y * width, width);
    };
    across(begin - 1);
    across(begin);
    for (int z = begin; z < end; ++z) {
      across(z + 1);
      for (int y = 0; y < l.rows; ++y) {
        add_three<Real>(kept(z - 1) + y * width, kept(z) + y * width, kept(z + 1) + y * width, line, width);
        line[-1] = line[1];
        line[a.nodes] = line[a.nodes - 2];
        const long row = z * l.plane + y * l.row;
        correct_row(a, line, l.v[d] + row, l.u[d] + row);
      }
    }
  }
}

template void average(const LatticeView<float>&, const LatticeAverage<float>&, int, int);
template void average(const LatticeView<double>&, const LatticeAverage<double>&, int, int);

}  // namespace springproof::SPRINGPROOF_KERNEL_NAMESPACE

#include "msm/multigrid/network_multigrid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "msm/algebra/fixed.h"
#include "msm/algebra/noise.h"
#include "msm/kernels/list_stiffness.h"
#include "msm/laws/capabilities.h"
#include "msm/multigrid/v_cycle.h"
#include "msm/parameters/calibrate.h"
#include "msm/topology/cubic_lattice.h"

namespace springproof {
namespace {

constexpr double auxiliary_spacings = 1.75;  // cell edge over mean node distance: 1.5 to 2 differ little
constexpr double largest_kappa = 8;          // times G: above it the lattice's own cycle converges badly
constexpr double smallest_fill = 0.1;

using Index = std::array<int, 3>;
using Weights = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// The auxiliary lattice: its cells contain all nodes of the network.
struct Auxiliary {
  Network network;  ///< cells and grid only
  std::vector<double> fill;
  std::vector<int> cell_of;  ///< per node of the network above
};

/// `aligned`: begins where the network does, so that the points of a lattice of half the edge lie on it or half way.
Auxiliary auxiliary_lattice(const Network& above, double edge, bool aligned) {
  const Vec3 lower = above.X.colwise().minCoeff().transpose(),
             extent = above.X.colwise().maxCoeff().transpose() - lower;
  Grid grid;
  grid.spacing = edge * Vec3::Ones();
  for (int d = 0; d < 3; ++d) grid.cells[d] = std::max(1, static_cast<int>(std::ceil(extent[d] / edge - 1e-9)));
  for (int d = 0; d < 3; ++d) grid.origin[d] = lower[d] - (aligned ? 0 : (grid.cells[d] * edge - extent[d]) / 2);
  Auxiliary aux;
  std::vector<int> number(std::size_t(grid.cells[0]) * grid.cells[1] * grid.cells[2], -1);
  for (int n = 0; n < above.nodes(); ++n) {
    Index at;
    for (int d = 0; d < 3; ++d)
      at[d] = std::clamp(static_cast<int>((above.X(n, d) - grid.origin[d]) / edge), 0, grid.cells[d] - 1);
    int& c = number[(std::size_t(at[2]) * grid.cells[1] + at[1]) * grid.cells[0] + at[0]];
    if (c < 0) {
      c = static_cast<int>(grid.cell_index.size());
      grid.cell_index.push_back(at);
      aux.fill.push_back(0);
    }
    aux.cell_of.push_back(c);
    aux.fill[c] += above.volume[n] / (edge * edge * edge);
  }
  for (double& f : aux.fill) f = std::clamp(f, smallest_fill, 1.0);
  std::vector<int> point(std::size_t(grid.cells[0] + 1) * (grid.cells[1] + 1) * (grid.cells[2] + 1), -1);
  std::vector<Vec3> position;
  for (const Index& at : grid.cell_index) {
    Hexahedron cell;
    for (int n = 0; n < 8; ++n) {
      const auto& corner = hexahedron_corners[n];
      const Index p = {at[0] + corner[0], at[1] + corner[1], at[2] + corner[2]};
      int& i = point[(std::size_t(p[2]) * (grid.cells[1] + 1) + p[1]) * (grid.cells[0] + 1) + p[0]];
      if (i < 0) {
        i = static_cast<int>(position.size());
        position.push_back(grid.origin + edge * Vec3(p[0], p[1], p[2]));
      }
      cell[n] = i;
    }
    aux.network.cells.corners.push_back(cell);
  }
  aux.network.X.resize(static_cast<Eigen::Index>(position.size()), 3);
  for (std::size_t i = 0; i < position.size(); ++i)
    aux.network.X.row(static_cast<Eigen::Index>(i)) = position[i].transpose();
  aux.network.cells.edge = edge;
  aux.network.cells.grid = std::move(grid);
  return aux;
}

/// Trilinear weights of the lattice's points, a row for each of the network's nodes.
Weights trilinear_weights(const Network& above, const Auxiliary& aux) {
  Weights weights(above.nodes(), aux.network.nodes());
  weights.reserve(Eigen::VectorXi::Constant(above.nodes(), 8));
  for (int n = 0; n < above.nodes(); ++n) {
    const Hexahedron& cell = aux.network.cells.corners[aux.cell_of[n]];
    const Vec3 xi = (above.X.row(n) - aux.network.X.row(cell[0])).transpose() / aux.network.cells.edge;
    for (int c = 0; c < 8; ++c) {
      double weight = 1;
      for (int d = 0; d < 3; ++d) weight *= hexahedron_corners[c][d] ? xi[d] : 1 - xi[d];
      if (weight >= 1e-12) weights.insert(n, cell[c]) = weight;
    }
  }
  weights.makeCompressed();
  return weights;
}

/// Lattice unknowns at least half of whose weight acts on fixed unknowns.
std::vector<char> held_unknowns(const std::vector<char>& fixed, const Weights& weights) {
  const Eigen::VectorXd of_fixed =
      Eigen::Map<const Eigen::Matrix<char, Eigen::Dynamic, 1>>(fixed.data(), 3 * weights.rows()).cast<double>();
  const NodalVectors held = weights.transpose() * by_point(of_fixed);
  const Eigen::VectorXd all = weights.transpose() * Eigen::VectorXd::Ones(weights.rows());
  std::vector<char> lattice_fixed;
  for (Eigen::Index p = 0; p < all.size(); ++p)
    for (int d = 0; d < 3; ++d) lattice_fixed.push_back(held(p, d) >= 0.5 * all[p]);
  return lattice_fixed;
}

/// One HybMSS cell with the network's shear modulus and what dispersion adds to lambda.
CellMatrix auxiliary_cell(const MassSpringModel& model, double edge) {
  MassSpringModel cell;
  cell.network = cubic_lattice(block_mesh(edge * Vec3::Ones(), {1, 1, 1}), isotropic_pattern(2));
  const double G = affine_shear_modulus(model);
  calibrate(G, cell.network);
  const MomentumDispersion* dispersion = dispersion_of(model);
  const AveragedSprings* averaged = averaged_springs_of(model);
  const double kappa = dispersion ? 2 * dispersion->q * 5 / 3 * G : averaged ? averaged->lame_lambda - G : 0;
  cell.laws = {Springs{}, VolumeCorrection{std::min(kappa, largest_kappa * G)}};
  return cell_stiffness(cell).total;
}

constexpr int degree = 3;
constexpr int power_steps = 15;
constexpr double power_margin = 1.1;  // safety factor for unconverged power iterations

/// Inverse of a node's block, without the rows and columns of its fixed unknowns.
Eigen::Matrix3d inverse_block(Eigen::Matrix3d block, const char* fixed) {
  for (int d = 0; d < 3; ++d)
    if (fixed[d]) {
      block.row(d).setZero();
      block.col(d).setZero();
      block(d, d) = 1;
    }
  Eigen::Matrix3d inverse = block.inverse();
  for (int d = 0; d < 3; ++d)
    if (fixed[d]) inverse(d, d) = 0;
  return inverse;
}

/// Pseudo-random start vector of power iterations.
Eigen::VectorXd rough(Eigen::Index size) {
  Eigen::VectorXd v(size);
  fill_with_noise(v);
  return v;
}

class ListSmoother : public NetworkSmoother {
 public:
  ListSmoother(const MassSpringModel& model, const std::vector<char>& fixed)
      : unit_(mean_stiffness(model.network)),
        blocks_(std::make_shared<SpringBlocks>(model.network)),
        exact_(model, blocks_),
        K_(exact_, unit_),
        z_(blocks_->order.size(), Padded<float>{}) {
    x_ = r_ = y_ = z_;
    std::vector<Eigen::Matrix3d> block = exact_.node_blocks();
    inverse_.resize(3 * z_.size());
    for (std::size_t p = 0; p < z_.size(); ++p) {
      const Eigen::Matrix3d inverse = unit_ * inverse_block(block[p], &fixed[3 * blocks_->order[p]]);
      for (int a = 0; a < 3; ++a)
        for (int d = 0; d < 3; ++d) inverse_[3 * p + a].v[d] = static_cast<float>(inverse(a, d));
    }
    // For springs alone k (n . du)^2 <= 2 k ((n . u_i)^2 + (n . u_j)^2).
    largest_eigenvalue_ = dispersion_of(model) ? power_margin * power_estimate() : 2;
  }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override { exact_.multiply(x, y); }
  Eigen::VectorXd diagonal() const override { return exact_.diagonal(); }

  void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) override {
    const double largest = b.lpNorm<Eigen::Infinity>();
    scale_ = largest > 0 ? largest : 1;
    by_place(blocks_->order, b.data(), 1 / scale_, r_);
    clear(x_);
    clear(y_);
    for (int k = 1; k <= degree; ++k) {
      smooth(ChebyshevStep(k, largest_eigenvalue_));
      K_.add(z_.data(), y_.data());
    }
    for (std::size_t p = 0; p < r_.size(); ++p)
      for (int d = 0; d < 3; ++d) z_[p].v[d] = r_[p].v[d] - y_[p].v[d];
    r.resize(b.size());
    by_node(blocks_->order, z_, scale_, r.data());
  }

  void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) override {
    by_place(blocks_->order, correction.data(), unit_ / scale_, z_);
    for (std::size_t p = 0; p < x_.size(); ++p)
      for (int d = 0; d < 3; ++d) x_[p].v[d] += z_[p].v[d];
    K_.add(z_.data(), y_.data());  // in addition to K z from before()
    for (int k = 1; k <= degree; ++k) {
      smooth(ChebyshevStep(k, largest_eigenvalue_));
      if (k < degree) K_.add(z_.data(), y_.data());
    }
    x.resize(correction.size());
    by_node(blocks_->order, x_, scale_ / unit_, x.data());
  }

 private:
  static double mean_stiffness(const Network& network) {
    double sum = 0;
    for (const Spring& s : network.springs) sum += s.stiffness;
    return sum / static_cast<double>(network.springs.size());
  }

  static void clear(std::vector<Padded<float>>& v) { std::fill(v.begin(), v.end(), Padded<float>{}); }

  /// r -= y, z = previous z + step D^-1 r, x += z, y = 0.
  void smooth(const ChebyshevStep& by) {
    K_.kernels().smooth({static_cast<long>(z_.size()), static_cast<float>(by.previous), static_cast<float>(by.step),
                         inverse_.data(), y_.data(), r_.data(), z_.data(), x_.data()});
  }

  double power_estimate() {
    by_place(blocks_->order, rough(static_cast<Eigen::Index>(3 * z_.size())).data(), 1, r_);
    clear(y_);
    smooth(ChebyshevStep(0.0, 1.0));
    double estimate = 1;
    for (int i = 0; i < power_steps; ++i) {
      double square = 0;
      for (const Padded<float>& z : z_)
        for (float value : z.v) square += value * value;
      const float factor = static_cast<float>(1 / std::sqrt(square));
      for (Padded<float>& z : z_)
        for (float& value : z.v) value *= factor;
      clear(r_);
      K_.add(z_.data(), y_.data());
      smooth(ChebyshevStep(0.0, -1.0));  // z = D^-1 y
      square = 0;
      for (const Padded<float>& z : z_)
        for (float value : z.v) square += value * value;
      estimate = std::sqrt(square);
    }
    return estimate;
  }

  double unit_;
  std::shared_ptr<const SpringBlocks> blocks_;
  ListStiffness<double> exact_;
  ListStiffness<float> K_;  ///< in units of the mean spring, against overflow in single precision
  std::vector<Padded<float>> inverse_, z_, x_, r_, y_;
  double largest_eigenvalue_ = 0, scale_ = 1;
};

class AssembledSmoother : public NetworkSmoother {
 public:
  AssembledSmoother(const MassSpringModel& model, const std::vector<char>& fixed)
      : K_(tangent(model, model.network.X)), inverse_(K_.node_blocks()) {
    for (std::size_t n = 0; n < inverse_.size(); ++n) inverse_[n] = inverse_block(inverse_[n], &fixed[3 * n]);
    Eigen::VectorXd v, Kv = rough(static_cast<Eigen::Index>(fixed.size()));
    for (int i = 0; i < power_steps; ++i) {
      block_jacobi(Kv, v);
      v.normalize();
      K_.multiply(v, Kv);
    }
    block_jacobi(Kv, v);
    largest_eigenvalue_ = power_margin * v.norm();
  }

  void multiply(const Eigen::VectorXd& x, Eigen::VectorXd& y) const override { K_.multiply(x, y); }
  Eigen::VectorXd diagonal() const override { return K_.diagonal(); }

  void before(const Eigen::VectorXd& b, Eigen::VectorXd& r) override {
    x_.setZero(b.size());
    r_ = b;
    smooth(true);
    r = r_;
  }

  void after(const Eigen::VectorXd& correction, Eigen::VectorXd& x) override {
    x_ += correction;
    K_.multiply(correction, Kz_);
    r_ -= Kz_;
    smooth(false);
    x = x_;
  }

 private:
  void smooth(bool update_residual) {
    z_.setZero(r_.size());
    for (int k = 1; k <= degree; ++k) {
      block_jacobi(r_, Dr_);
      const ChebyshevStep by(k, largest_eigenvalue_);
      z_ = by.previous * z_ + by.step * Dr_;
      x_ += z_;
      if (k == degree && !update_residual) return;
      K_.multiply(z_, Kz_);
      r_ -= Kz_;
    }
  }

  void block_jacobi(const Eigen::VectorXd& r, Eigen::VectorXd& z) const {
    z.resize(r.size());
    for (std::size_t n = 0; n < inverse_.size(); ++n) z.segment<3>(3 * n) = inverse_[n] * r.segment<3>(3 * n);
  }

  Tangent K_;
  std::vector<Eigen::Matrix3d> inverse_;
  double largest_eigenvalue_ = 0;
  Eigen::VectorXd x_, r_, z_, Dr_, Kz_;
};

}  // namespace

NetworkMultigrid::NetworkMultigrid(const MassSpringModel& model, const std::vector<char>& fixed)
    : fixed_(fixed), smoother_(network_smoother(model, fixed)) {
  const Network& network = model.network;
  const double edge = network.cells.empty() ? auxiliary_spacings * std::cbrt(network.volume.sum() / network.nodes())
                                            : 2 * network.cells.edge;
  const Auxiliary aux = auxiliary_lattice(network, edge, network.cells.cut());
  weights_ = trilinear_weights(network, aux);
  lattice_fixed_ = held_unknowns(fixed, weights_);
  lattice_ = std::make_unique<Multigrid>(lattice_levels(aux.network, lattice_fixed_, 900, aux.fill),
                                         auxiliary_cell(model, edge), true);
  coarse_r_.resize(3 * weights_.cols());
  correction_.resize(3 * weights_.rows());
}

void NetworkMultigrid::apply(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
  smoother_->before(b, residual_);
  clear_fixed(fixed_, residual_);
  by_point(coarse_r_) = weights_.transpose() * by_point(residual_);
  clear_fixed(lattice_fixed_, coarse_r_);
  lattice_->apply(coarse_r_, coarse_x_);
  by_point(correction_) = weights_ * by_point(coarse_x_);
  clear_fixed(fixed_, correction_);
  smoother_->after(correction_, x);
}

std::unique_ptr<NetworkSmoother> network_smoother(const MassSpringModel& model, const std::vector<char>& fixed) {
  if (can(model, Capability::list_stiffness)) return std::make_unique<ListSmoother>(model, fixed);
  return std::make_unique<AssembledSmoother>(model, fixed);
}

}  // namespace springproof

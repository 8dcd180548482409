#include "fem_reference/solvers/coarsest_level.h"

#include "fem_reference/grid/processes.h"
#include "fem_reference/solvers/assembled_operator.h"

namespace springproof::fem {
namespace {

using dealii::types::global_dof_index;

/// Interpolation matrix from linear elements to the degrees of freedom of a level, by rows; empty rows where
/// prescribed.
struct Interpolation {
  std::vector<std::size_t> start;
  std::vector<global_dof_index> column;
  std::vector<float> weight;
};

class LinearElements {
 public:
  /// On the coarsest cells of the body, triangulated once more; null: those of a body that is not refined.
  LinearElements(std::unique_ptr<Body3> coarsest, const ElasticSystem& fine)
      : own_(std::move(coarsest)), body_(own_ ? *own_ : fine.body), handler_(body_.triangulation) {
    handler_.distribute_dofs(*displacement_element(body_, 1));
    interpolate_to(fine);
    // The operator of the multigrid: for the mixed form the shear part alone.
    const bool mixed = fine.form == Form::mixed;
    system_.emplace(ElasticSystem{body_, handler_, 1, mixed ? Form::pointwise : fine.form, fine.mu,
                                  mixed ? 0 : fine.lambda, held_});
    operator_.emplace(*system_, std::nullopt);
    r_ = z_ = operator_->vector().u;
  }

  const std::string& name() const { return operator_->preconditioner(); }

  // x = P (one cycle for P^T b)
  void cycle(LevelVector& x, const LevelVector& b) {
    r_ = 0;
    for (std::size_t i = 0; i + 1 < p_.start.size(); ++i)
      for (std::size_t k = p_.start[i]; k < p_.start[i + 1]; ++k) r_(p_.column[k]) += p_.weight[k] * b(i);
    operator_->precondition_displacement(z_, r_);
    for (std::size_t i = 0; i + 1 < p_.start.size(); ++i) {
      double sum = 0;
      for (std::size_t k = p_.start[i]; k < p_.start[i + 1]; ++k) sum += p_.weight[k] * z_(p_.column[k]);
      x(i) = float(sum);
    }
  }

 private:
  void interpolate_to(const ElasticSystem& fine) {
    const auto &fe = fine.dof_handler.get_fe(), &linear = handler_.get_fe();
    const bool has_levels = fine.dof_handler.has_level_dofs();
    dealii::IndexSet prescribed(has_levels ? fine.dof_handler.n_dofs(0) : fine.dof_handler.n_dofs());
    if (has_levels)
      prescribed = fine.level_constrained[0];
    else
      prescribed.add_indices(fine.constrained.begin(), fine.constrained.end());
    std::vector<std::vector<std::pair<global_dof_index, float>>> rows(prescribed.size());
    std::vector<char> held(handler_.n_dofs(), 0);
    std::vector<global_dof_index> own(linear.n_dofs_per_cell()), on_level(fe.n_dofs_per_cell());
    for (const auto& cell : handler_.active_cell_iterators()) {
      const auto& cells = fine.body.triangulation;
      cell->get_dof_indices(own);
      if (has_levels)
        dealii::DoFHandler<3>::level_cell_iterator(&cells, 0, cell->index(), &fine.dof_handler)
            ->get_mg_dof_indices(on_level);
      else
        dealii::DoFHandler<3>::active_cell_iterator(&cells, 0, cell->index(), &fine.dof_handler)
            ->get_dof_indices(on_level);
      // The vertex degrees of freedom of a cell come first in every element.
      for (std::size_t j = 0; j < own.size(); ++j) held[own[j]] |= char(prescribed.is_element(on_level[j]));
      for (unsigned int i = 0; i < on_level.size(); ++i) {
        auto& row = rows[on_level[i]];
        if (!row.empty()) continue;
        for (unsigned int j = 0; j < own.size(); ++j)
          if (linear.system_to_component_index(j).first == fe.system_to_component_index(i).first)
            if (const double w = linear.shape_value(j, fe.unit_support_point(i)); std::abs(w) > 1e-12)
              row.emplace_back(own[j], float(w));
      }
    }
    for (std::size_t j = 0; j < held.size(); ++j)
      if (held[j]) held_.push_back(unsigned(j));
    p_.start.push_back(0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (!prescribed.is_element(i))
        for (const auto& [column, weight] : rows[i])
          if (!held[column]) {
            p_.column.push_back(column);
            p_.weight.push_back(weight);
          }
      p_.start.push_back(p_.column.size());
    }
  }

  std::unique_ptr<Body3> own_;
  const Body3& body_;
  dealii::DoFHandler<3> handler_;
  Interpolation p_;
  std::vector<unsigned int> held_;
  std::optional<ElasticSystem> system_;
  std::optional<assembled::AssembledOperator> operator_;
  DofVector r_, z_;
};

}  // namespace

void add_linear_coarse_space(const Mesh& coarse, const std::function<Vec3(const Vec3&)>& place, ElasticSystem& system) {
  start_mpi();
  const bool refined = system.dof_handler.has_level_dofs();
  const auto below = std::make_shared<LinearElements>(refined ? triangulate(coarse, 0, place) : nullptr, system);
  system.below_name = below->name();
  system.below = [below](LevelVector& x, const LevelVector& b) { below->cycle(x, b); };
}

std::function<void(DofVector&, const DofVector&)> factored_stiffness(const ElasticSystem& system) {
  if (system.dof_handler.n_dofs() > most_factored_for_thin_bodies) return {};
  start_mpi();
  const auto shear = std::make_shared<ElasticSystem>(system);
  if (shear->form == Form::mixed) {
    shear->form = Form::pointwise;
    shear->lambda = 0;
  }
  shear->plain_gamg = true;
  shear->most_factored = most_factored_for_thin_bodies;
  const auto factors = std::make_shared<assembled::AssembledOperator>(*shear, std::nullopt);
  return [shear, factors](DofVector& z, const DofVector& r) { factors->precondition_displacement(z, r); };
}

}  // namespace springproof::fem

#include "msm/dynamics/terms/plane_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

namespace springproof {
namespace {

constexpr int most_sweeps = 200;    // what they leave is corrected at the end of the next step
constexpr double tolerance = 1e-7;  // of the last sweep's change of velocity, relative to the largest that is asked for

PointWeights each_of(Eigen::Index nodes) {
  PointWeights points(nodes, nodes);
  points.setIdentity();
  return points;
}

constexpr double round_off = 1e-9;  // of distances relative to the spacing of the nodes, of reactions to the forces
constexpr double layer = 0.5;       // nodes that touch together, relative to the spacing
constexpr double stiffening = 1e6;

}  // namespace

void ContactImpulse::add(const Vec3& impulse, const Vec3& at) {
  linear += impulse;
  angular += at.cross(impulse);
}

PlaneContact::PlaneContact(const Plane& plane, const Eigen::VectorXd& mass, double pause, PointWeights points)
    : plane_(plane),
      mass_(mass),
      pause_(pause),
      of_nodes_(points.rows() == 0),
      points_(points.rows() > 0 ? std::move(points) : each_of(mass.size())),
      latest_(NodalVectors::Zero(points_.rows(), 3)) {}

/// Inverse masses, zero of nodes that take no impulse.
Eigen::VectorXd PlaneContact::mobilities(const std::vector<char>& fixed) const {
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(mass_.size());
  for (Eigen::Index n = 0; n < mass_.size(); ++n)
    if (mass_[n] > 0 && !fixed[3 * n] && !fixed[3 * n + 1] && !fixed[3 * n + 2]) inverse[n] = 1 / mass_[n];
  return inverse;
}

Vec3 PlaneContact::at(int point, const NodalVectors& of_nodes) const {
  Vec3 sum = Vec3::Zero();
  for (PointWeights::InnerIterator w(points_, point); w; ++w) sum += w.value() * of_nodes.row(w.col()).transpose();
  return sum;
}

void PlaneContact::push(int point, const Vec3& impulse, const Eigen::VectorXd& inverse_mass, NodalVectors& v) const {
  for (PointWeights::InnerIterator w(points_, point); w; ++w)
    v.row(w.col()) += w.value() * inverse_mass[w.col()] * impulse.transpose();
}

void PlaneContact::add(int point, double velocity, const Eigen::VectorXd& inverse_mass, Touching& touching) const {
  double mobility = 0;
  for (PointWeights::InnerIterator w(points_, point); w; ++w) mobility += w.value() * w.value() * inverse_mass[w.col()];
  if (mobility > 0) touching.push_back({point, mobility, velocity, Vec3::Zero()});
}

void PlaneContact::solve(double friction, const Eigen::VectorXd& inverse_mass, Touching& touching,
                         NodalVectors& v) const {
  const Vec3& n = plane_.normal;
  double asked = 0, fastest = 0;
  for (const Touch& t : touching) {
    const Vec3 velocity = at(t.point, v);
    asked = std::max(asked, t.velocity - n.dot(velocity));
    fastest = std::max(fastest, velocity.norm());
  }
  const double enough = std::max(tolerance * asked, std::numeric_limits<double>::epsilon() * fastest);
  for (const Touch& t : touching) push(t.point, t.impulse, inverse_mass, v);
  double change = 2 * enough;
  for (int sweep = 0; sweep < most_sweeps && change > enough; ++sweep) {
    change = 0;
    for (Touch& t : touching) {
      const Vec3 velocity = at(t.point, v);
      const double before = n.dot(t.impulse), into = n.dot(velocity);
      const double normal = std::max(0.0, before + (t.velocity - into) / t.mobility);
      Vec3 along = t.impulse - before * n - (velocity - into * n) / t.mobility;
      if (const double size = along.norm(); size > friction * normal) along *= friction * normal / size;
      const Vec3 further = normal * n + along - t.impulse;
      t.impulse += further;
      push(t.point, further, inverse_mass, v);
      change = std::max(change, t.mobility * further.norm());
    }
  }
}

bool PlaneContact::correct(double dt, double damping, const std::vector<char>& fixed, NodalVectors& x,
                           NodalVectors& v) {
  const Eigen::VectorXd inverse_mass = mobilities(fixed);
  Touching touching;
  for (int p = 0; p < points_.rows(); ++p)
    if (const double distance = plane_.distance(at(p, x)); distance < 0)
      add(p, plane_.normal.dot(at(p, v)) - distance / dt, inverse_mass, touching);
  for (Touch& t : touching) t.impulse = latest_.row(t.point).transpose();
  latest_.setZero();
  if (touching.empty()) return false;
  const NodalVectors without = v;
  solve(plane_.friction, inverse_mass, touching, v);
  for (const Touch& t : touching) {
    impulse_.add((1 + damping * dt) * t.impulse, at(t.point, x) - dt * at(t.point, without));
    latest_.row(t.point) = t.impulse.transpose();
  }
  x += dt * (v - without);
  touches_ = true;
  return true;
}

void PlaneContact::count(const ContactImpulse& further) {
  touches_ = true;
  impulse_.linear += further.linear;
  impulse_.angular += further.angular;
}

void PlaneContact::observe(double time, const NodalVectors& v) {
  const double before = std::exchange(velocity_, plane_.normal.dot(Vec3(v.transpose() * mass_)) / mass_.sum());
  if (touches_ && !first_) first_ = Bounce{time, time, before, before};
  if (touches_ && !ended_) {
    first_->end = time;
    first_->velocity_after = velocity_;
  }
  touches_ = false;
  if (first_ && time - first_->end > pause_) ended_ = true;
}

NodalVectors PlaneContact::stopped(const std::vector<char>& fixed, NodalVectors v) const {
  const Eigen::VectorXd inverse_mass = mobilities(fixed);
  Touching touching;
  for (int p = 0; p < points_.rows(); ++p)
    if (plane_.normal.dot(Vec3(latest_.row(p).transpose())) > 0) add(p, 0, inverse_mass, touching);
  solve(0, inverse_mass, touching, v);
  return v;
}

ContactImpulse PlaneContact::take_impulse() { return std::exchange(impulse_, {}); }

std::optional<Bounce> PlaneContact::bounce() const { return ended_ ? first_ : std::nullopt; }

PlaneConstraint::PlaneConstraint(const Plane& plane, Eigen::Index nodes, double spacing)
    : plane_(plane), spacing_(spacing), is_held_(nodes, 0) {}

void PlaneConstraint::put(NodalVectors& x) const {
  for (const int n : held_) x.row(n) -= plane_.distance(x.row(n).transpose()) * plane_.normal.transpose();
}

void PlaneConstraint::project(NodalVectors& v) const {
  for (const int n : held_) v.row(n) -= plane_.normal.dot(Vec3(v.row(n).transpose())) * plane_.normal.transpose();
}

void PlaneConstraint::stiffen(BlockMatrix& K) const {
  for (const int n : held_) K.add(n, n, stiffening * K.at(n, n).trace() * plane_.normal * plane_.normal.transpose());
}

bool PlaneConstraint::revise(const NodalVectors& x0, const NodalVectors& x1, const NodalVectors& unbalanced,
                             double scale, const std::vector<char>& fixed) {
  const auto free = [&](Eigen::Index n) { return !fixed[3 * n] && !fixed[3 * n + 1] && !fixed[3 * n + 2]; };
  const auto distance = [&](const NodalVectors& x, Eigen::Index n) { return plane_.distance(x.row(n).transpose()); };
  const auto pulls = [&](Eigen::Index n) {
    return plane_.normal.dot(Vec3(unbalanced.row(n).transpose())) > round_off * scale;
  };
  const auto is_behind = [&](Eigen::Index n) {
    return !is_held_[n] && free(n) && distance(x1, n) < -round_off * spacing_;
  };
  // Of those behind it the plane holds the layer next to it, which may hold back the others.
  double nearest = std::numeric_limits<double>::infinity();
  for (Eigen::Index n = 0; n < x1.rows(); ++n)
    if (is_behind(n)) nearest = std::min(nearest, distance(x0, n));
  std::vector<char> held(is_held_.size(), 0);
  for (Eigen::Index n = 0; n < x1.rows(); ++n)
    held[n] = is_held_[n] ? free(n) && !pulls(n) : is_behind(n) && distance(x0, n) <= nearest + layer * spacing_;
  if (held == is_held_) return false;
  is_held_ = std::move(held);
  held_.clear();
  for (std::size_t n = 0; n < is_held_.size(); ++n)
    if (is_held_[n]) held_.push_back(static_cast<int>(n));
  return true;
}

}  // namespace springproof

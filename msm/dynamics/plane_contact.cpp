#include "msm/dynamics/plane_contact.h"

#include <algorithm>
#include <utility>

namespace springproof {

PlaneContact::PlaneContact(const Plane& plane, const Eigen::VectorXd& mass, double pause)
    : plane_(plane), mass_(mass), pause_(pause) {}

double PlaneContact::velocity_of_centre(const NodalVectors& v) const {
  return plane_.normal.dot(Vec3(v.transpose() * mass_)) / mass_.sum();
}

bool PlaneContact::correct(double time, double dt, const std::vector<char>& fixed, NodalVectors& x, NodalVectors& v) {
  const double before = velocity_of_centre(v);
  bool touches = false;
  for (Eigen::Index n = 0; n < x.rows(); ++n) {
    const double distance = plane_.distance(x.row(n).transpose());
    if (!(distance < 0) || fixed[3 * n] || fixed[3 * n + 1] || fixed[3 * n + 2]) continue;
    touches = true;
    const Vec3 speed = v.row(n).transpose();
    const Vec3 along = speed - plane_.normal.dot(speed) * plane_.normal;
    Vec3 change = -distance / dt * plane_.normal;
    if (const double sliding = along.norm(); sliding > 0)
      change -= std::min(1.0, plane_.friction * -distance / dt / sliding) * along;
    v.row(n) += change.transpose();
    x.row(n) += dt * change.transpose();
    impulse_ += mass_[n] * change;
  }
  if (touches && !first_) first_ = Bounce{time, time, before, before};
  if (touches && !ended_) {
    first_->end = time;
    first_->velocity_after = velocity_of_centre(v);
  }
  if (first_ && time - first_->end > pause_) ended_ = true;
  return touches;
}

Vec3 PlaneContact::take_impulse() { return std::exchange(impulse_, Vec3::Zero()); }

std::optional<Bounce> PlaneContact::bounce() const { return ended_ ? first_ : std::nullopt; }

}  // namespace springproof

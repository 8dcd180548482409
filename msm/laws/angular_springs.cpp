#include "msm/laws/angular_springs.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

namespace springproof {
namespace {

/// The sides of a triangle that leave the corner a, towards b and c.
struct Corner {
  int a, b, c;
  Vec3 d1, d2;

  Corner(const std::array<int, 3>& triangle, int corner, const NodalVectors& x)
      : a(triangle[corner]),
        b(triangle[(corner + 1) % 3]),
        c(triangle[(corner + 2) % 3]),
        d1((x.row(b) - x.row(a)).transpose()),
        d2((x.row(c) - x.row(a)).transpose()) {}

  double angle() const { return std::atan2(d1.cross(d2).norm(), d1.dot(d2)); }
};

/// dphi/dd1 = -t1/l1 and dphi/dd2 = -t2/l2, with t1 and t2 the unit vectors across d1 and d2 that point into the angle.
struct AngleGradient {
  double l1, l2, cosine, sine;
  Vec3 e1, e2, t1, t2, normal;

  explicit AngleGradient(const Corner& corner)
      : l1(corner.d1.norm()), l2(corner.d2.norm()), e1(corner.d1 / l1), e2(corner.d2 / l2) {
    normal = e1.cross(e2);
    sine = normal.norm();
    cosine = e1.dot(e2);
    normal /= sine;
    t1 = normal.cross(e1);
    t2 = e2.cross(normal);
  }
  Vec3 by_d1() const { return -t1 / l1; }
  Vec3 by_d2() const { return -t2 / l2; }
};

template <class Function>
void for_each_corner(const Network& network, const NodalVectors& x, const Function& f) {
  for (const auto& triangle : network.triangles)
    for (int corner = 0; corner < 3; ++corner) {
      const Corner now(triangle, corner, x);
      f(now, now.angle() - Corner(triangle, corner, network.X).angle());
    }
}

}  // namespace

double AngularSprings::energy(const Network& network, const NodalVectors& x) const {
  double sum = 0;
  for_each_corner(network, x, [&](const Corner&, double opening) { sum += 0.5 * beta * opening * opening; });
  return sum;
}

void AngularSprings::add_forces(const Network& network, const NodalVectors& x, NodalVectors& f) const {
  for_each_corner(network, x, [&](const Corner& corner, double opening) {
    const AngleGradient angle(corner);
    const Vec3 on_b = -beta * opening * angle.by_d1(), on_c = -beta * opening * angle.by_d2();
    f.row(corner.b) += on_b.transpose();
    f.row(corner.c) += on_c.transpose();
    f.row(corner.a) -= (on_b + on_c).transpose();
  });
}

void AngularSprings::add_tangent(const Network& network, const NodalVectors& x, BlockMatrix& K) const {
  for_each_corner(network, x, [&](const Corner& corner, double opening) {
    const AngleGradient g(corner);
    const Eigen::Matrix3d nn = g.normal * g.normal.transpose(), et1 = g.e1 * g.t1.transpose(),
                          et2 = g.e2 * g.t2.transpose();
    const double moment = beta * opening;
    const Eigen::Matrix3d by_11 = beta * g.by_d1() * g.by_d1().transpose() +
                                  moment / (g.l1 * g.l1) * (et1 + et1.transpose() + g.cosine / g.sine * nn);
    const Eigen::Matrix3d by_22 = beta * g.by_d2() * g.by_d2().transpose() +
                                  moment / (g.l2 * g.l2) * (et2 + et2.transpose() + g.cosine / g.sine * nn);
    const Eigen::Matrix3d by_12 = beta * g.by_d1() * g.by_d2().transpose() - moment / (g.l1 * g.l2 * g.sine) * nn;
    const Eigen::Matrix3d by_21 = by_12.transpose();
    K.add(corner.b, corner.b, by_11);
    K.add(corner.c, corner.c, by_22);
    K.add(corner.b, corner.c, by_12);
    K.add(corner.c, corner.b, by_21);
    K.add(corner.a, corner.b, -by_11 - by_21);
    K.add(corner.b, corner.a, -by_11 - by_12);
    K.add(corner.a, corner.c, -by_12 - by_22);
    K.add(corner.c, corner.a, -by_21 - by_22);
    K.add(corner.a, corner.a, by_11 + by_12 + by_21 + by_22);
  });
}

double angular_stiffness(double k, double a, double nu_2d) {
  if (!(nu_2d > -1 && nu_2d < 1))
    throw std::invalid_argument(fmt::format("plane Poisson's ratio {} is not in (-1, 1)", nu_2d));
  return k * a * a / 6 * (1 - 3 * nu_2d) / (1 + nu_2d);
}

}  // namespace springproof

// Bullet (zlib licence): a deformable body of the tetrahedra of a body exported with --to bullet.
//
//   bullet BODY.json OUT.csv
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

using Json = nlohmann::json;
using Vectors = std::vector<btVector3>;

/// Nodes with their masses, and tetrahedra; nothing collides, nothing is damped.
btSoftBody* soft_body(const Json& file, btSoftBodyWorldInfo& info) {
  Vectors x;
  for (const Json& p : file.at("nodes").at("position_m"))
    x.emplace_back(p[0].get<btScalar>(), p[1].get<btScalar>(), p[2].get<btScalar>());
  const std::vector<btScalar> mass = file.at("nodes").at("mass_kg");
  auto* body = new btSoftBody(&info, int(x.size()), x.data(), mass.data());
  for (const auto& [patch, nodes] : file.at("pins").items())
    for (const int n : nodes) body->setMass(n, 0);
  const Json& tetrahedra = file.at("tetrahedra").at("nodes");
  for (const Json& t : tetrahedra) body->appendTetra(t[0], t[1], t[2], t[3]);
  for (auto* scratch : {&body->m_tetraScratches, &body->m_tetraScratchesTn})
    scratch->resize(int(tetrahedra.size()));  // which Bullet 3.24 leaves empty and writes into
  body->initializeDmInverse();
  body->m_cfg.kDP = 0;
  body->m_cfg.collisions = 0;
  body->setActivationState(DISABLE_DEACTIVATION);
  body->m_sleepingThreshold = 0;
  return body;
}

Vectors positions(const btSoftBody& body) {
  Vectors x;
  for (int i = 0; i < body.m_nodes.size(); ++i) x.push_back(body.m_nodes[i].m_x);
  return x;
}

/// Root of the sum of the squared distances.
double distance(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += double((a[i] - b[i]).length2());
  return std::sqrt(sum);
}

/// Lets the body come to rest as settle.mjs does.
void settle(btDynamicsWorld& world, btSoftBody& body) {
  constexpr btScalar frame = btScalar(1.0 / 60);
  Vectors x = positions(body);
  double speed = 0, fastest = 0, quarter = HUGE_VAL;
  for (int frames = 1; frames < 21 * quarter; ++frames) {
    world.stepSimulation(frame, 1, frame);
    const Vectors before = std::exchange(x, positions(body));
    speed = distance(x, before);
    if (!std::isfinite(speed) || (frames > 1000 && std::isinf(quarter)))
      throw std::runtime_error("the body does not come to rest");
    if (speed < fastest) quarter = std::min(quarter, double(frames));
    fastest = std::max(fastest, speed);
    const auto share = btScalar(std::exp(-M_PI / quarter));
    for (int i = 0; i < body.m_nodes.size(); ++i)
      body.m_nodes[i].m_v = body.m_nodes[i].m_vn = body.m_nodes[i].m_v * share;
  }
  if (speed > 5e-3 * fastest) throw std::runtime_error("the body does not come to rest");
}

void write(const Vectors& rest, const Vectors& x, const char* name) {
  std::ofstream out(name);
  out.precision(9);
  out << "x,y,z,X,Y,Z\n";
  for (std::size_t i = 0; i < x.size(); ++i)
    out << rest[i].x() << ',' << rest[i].y() << ',' << rest[i].z() << ',' << x[i].x() << ',' << x[i].y() << ','
        << x[i].z() << '\n';
  if (!out.flush()) throw std::runtime_error(std::string("cannot write ") + name);
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: bullet BODY.json OUT.csv");
  const Json file = Json::parse(std::ifstream(argv[1]));
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btDeformableBodySolver solver;
  btDeformableMultiBodyConstraintSolver constraints;
  constraints.setDeformableSolver(&solver);
  btDeformableMultiBodyDynamicsWorld world(&dispatcher, &broadphase, &constraints, &configuration, &solver);
  btSoftBody* body = soft_body(file, world.getWorldInfo());
  world.addSoftBody(body);
  const Json& constants = file.at("engine").at("neo_hooke");  // not the Lame constants: docs/engines.md
  btDeformableNeoHookeanForce elastic(constants.at("mu_Pa"), constants.at("lambda_Pa"), 0);
  btDeformableGravityForce gravity(btVector3(0, 0, btScalar(-9.81)));
  world.addForce(body, &elastic);
  world.addForce(body, &gravity);
  world.setImplicit(true);
  world.setLineSearch(false);
  world.setUseProjection(true);
  const Vectors rest = positions(*body);
  settle(world, *body);
  write(rest, positions(*body), argv[2]);
  std::exit(0);  // the world is not taken apart
} catch (const std::exception& e) {
  std::fprintf(stderr, "bullet: %s\n", e.what());
  return 1;
}

// Bullet (zlib licence) as an engine of the bench: springproof-engine-bullet TASK.json (docs/measured/).
// A program of its own, built where Bullet's headers are; nothing of springproof is linked into it.  Set-ups: linear,
// neo_hooke (Lame constants of E and nu as entered), neo_hooke_converted (those of the file), links (position-based).
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableLinearElasticityForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;

btVector3 vector_of(const Json& a) { return {a[0].get<btScalar>(), a[1].get<btScalar>(), a[2].get<btScalar>()}; }
Json json_of(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

struct Bullet {
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btDeformableBodySolver deformable_solver;
  btDeformableMultiBodyConstraintSolver deformable_constraints;
  btSequentialImpulseConstraintSolver constraints;
  std::unique_ptr<btDynamicsWorld> world;
  std::unique_ptr<btDeformableLagrangianForce> elastic, gravity;
  btSoftBody* body = nullptr;  // owned by the world
};

/// Rows of three; none of null.
std::vector<btVector3> vectors_of(const Json& rows) {
  std::vector<btVector3> out;
  for (const Json& row : rows) out.push_back(vector_of(row));
  return out;
}

/// The elastic force, its damping set to nothing.
std::unique_ptr<btDeformableLagrangianForce> elastic_force(const std::string& set_up, const Json& model) {
  const Json& material = model.at("material");
  const double E = material.at("youngs_modulus_Pa"), nu = material.at("poisson_ratio");
  if (set_up == "linear") {
    auto force = std::make_unique<btDeformableLinearElasticityForce>(btScalar(1), btScalar(1), 0, 0);
    force->setYoungsModulus(btScalar(E)), force->setPoissonRatio(btScalar(nu));
    return force;
  }
  double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
  if (set_up == "neo_hooke_converted") {
    const Json& own = model.at("engine").at("neo_hooke");
    mu = own.at("mu_Pa"), lambda = own.at("lambda_Pa");
  }
  return std::make_unique<btDeformableNeoHookeanForce>(btScalar(mu), btScalar(lambda), btScalar(0));
}

/// The body's nodes, with their masses.
btSoftBody* body_of(const Json& task, const Json& model, btSoftBodyWorldInfo& info) {
  const std::vector<btVector3> x = vectors_of(model.at("nodes").at("position_m"));
  const std::vector<btScalar> mass = model.at("nodes").at("mass_kg");
  auto* body = new btSoftBody(&info, int(x.size()), x.data(), mass.data());
  if (task.at("pinned"))
    for (const auto& [patch, nodes] : model.at("pins").items())
      for (const int n : nodes) body->setMass(n, 0);
  body->m_cfg.kDP = 0;
  body->m_cfg.collisions = 0;
  body->setActivationState(DISABLE_DEACTIVATION);
  body->m_sleepingThreshold = 0;
  return body;
}

void make_deformable(const Json& task, const Json& model, Bullet& b) {
  b.deformable_constraints.setDeformableSolver(&b.deformable_solver);
  auto world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
      &b.dispatcher, &b.broadphase, &b.deformable_constraints, &b.configuration, &b.deformable_solver);
  b.body = body_of(task, model, world->getWorldInfo());
  const Json& tetrahedra = model.at("tetrahedra").at("nodes");
  for (const Json& t : tetrahedra) b.body->appendTetra(t[0], t[1], t[2], t[3]);
  for (auto* scratch : {&b.body->m_tetraScratches, &b.body->m_tetraScratchesTn})
    scratch->resize(int(tetrahedra.size()));
  b.body->initializeDmInverse();
  world->addSoftBody(b.body);
  b.elastic = elastic_force(task.at("set_up"), model);
  world->addForce(b.body, b.elastic.get());
  b.gravity = std::make_unique<btDeformableGravityForce>(vector_of(task.at("gravity_m_s2")));
  world->addForce(b.body, b.gravity.get());
  world->setImplicit(task.at("integrator") == "implicit");
  world->setLineSearch(false);
  world->setUseProjection(true);
  b.world = std::move(world);
}

void make_links(const Json& task, const Json& model, Bullet& b) {
  auto world =
      std::make_unique<btSoftRigidDynamicsWorld>(&b.dispatcher, &b.broadphase, &b.constraints, &b.configuration);
  world->setGravity(vector_of(task.at("gravity_m_s2")));
  world->getWorldInfo().m_gravity = vector_of(task.at("gravity_m_s2"));
  b.body = body_of(task, model, world->getWorldInfo());
  b.body->m_materials[0]->m_kLST = 1;
  for (const Json& e : model.at("edges").at("nodes")) b.body->appendLink(e[0].get<int>(), e[1].get<int>());
  b.body->m_cfg.piterations = task.at("iterations");
  world->addSoftBody(b.body);
  b.world = std::move(world);
}

/// (f(u) - f(-u)) / 2 of a displacement u [m].
Json forces_at(const std::vector<btVector3>& u, Bullet& b) {
  auto& nodes = b.body->m_nodes;
  btAlignedObjectArray<btVector3> f;
  for (int i = 0; i < nodes.size(); ++i) f.push_back(btVector3(0, 0, 0)), nodes[i].index = i;
  for (const btScalar sign : {btScalar(1), btScalar(-1)}) {
    for (int i = 0; i < nodes.size(); ++i) nodes[i].m_q = nodes[i].m_x + sign * u[std::size_t(i)];
    b.body->updateDeformation();
    b.elastic->addScaledForces(sign / 2, f);
  }
  Json out = Json::array();
  for (int i = 0; i < nodes.size(); ++i) out.push_back(json_of(f[i])), nodes[i].m_q = nodes[i].m_x;
  return out;
}

/// t, kinetic energy, mean position of the watched nodes, angular momentum about `centre`; masses are the file's.
Json sample(double time, const Json& task, const std::vector<double>& mass, const btVector3& centre, const Bullet& b) {
  double kinetic = 0, tip[3] = {}, spin[3] = {};
  for (std::size_t i = 0; i < mass.size(); ++i) {
    const auto& node = b.body->m_nodes[int(i)];
    const btVector3 l = (node.m_x - centre).cross(node.m_v);
    kinetic += 0.5 * mass[i] * double(node.m_v.length2());
    for (int c = 0; c < 3; ++c) spin[c] += mass[i] * double(l[c]);
  }
  for (std::size_t k = 0; k < task.at("watch").size(); ++k)
    for (int c = 0; c < 3; ++c)
      tip[c] += task["watch_weights"][k].get<double>() * double(b.body->m_nodes[task["watch"][k].get<int>()].m_x[c]);
  return {time, kinetic, tip[0], tip[1], tip[2], spin[0], spin[1], spin[2]};
}

/// Adds to velocities, or scales them; implicit steps start from m_vn.
template <class Change>
void change_velocities(Bullet& b, const Change& change) {
  for (int i = 0; i < b.body->m_nodes.size(); ++i) {
    auto& node = b.body->m_nodes[i];
    if (node.m_im > 0) node.m_vn = node.m_v = change(i, node.m_v);
  }
}

void push(const std::vector<btVector3>& velocities, btScalar share, Bullet& b) {
  if (!velocities.empty())
    change_velocities(b, [&](int i, const btVector3& v) { return btVector3(v + share * velocities[std::size_t(i)]); });
}

/// Steps; a force is a push before each, and velocities are scaled after each but the last `free_steps`.
void move(const Json& task, const Json& model, Bullet& b, Json& answer) {
  const std::vector<double> mass = model.at("nodes").at("mass_kg");
  const double dt = task.at("dt_s"), decay = std::exp(-task.at("damping_1_s").get<double>() * dt);
  const long steps = task.at("steps"), damped = steps - task.at("free_steps").get<long>(),
             every = task.at("sample_every");
  std::vector<btVector3> pushes = vectors_of(task.at("forces_N"));
  for (std::size_t i = 0; i < pushes.size(); ++i) pushes[i] /= btScalar(mass[i]);
  push(vectors_of(task.at("velocities_m_s")), 1, b);
  btVector3 centre(0, 0, 0);
  for (std::size_t i = 0; i < mass.size(); ++i) centre += b.body->m_nodes[int(i)].m_x / btScalar(mass.size());
  Json samples = Json::array(), positions = Json::array();
  samples.push_back(sample(0, task, mass, centre, b));
  double seconds = 0;
  for (long step = 1; step <= steps; ++step) {
    push(pushes, btScalar(dt), b);
    const std::clock_t before = std::clock();
    b.world->stepSimulation(btScalar(dt), 1, btScalar(dt));
    seconds += double(std::clock() - before) / CLOCKS_PER_SEC;
    if (step <= damped && decay < 1)
      change_velocities(b, [decay](int, const btVector3& v) { return btVector3(v * btScalar(decay)); });
    if (step % every == 0 || step == steps) samples.push_back(sample(double(step) * dt, task, mass, centre, b));
  }
  for (int i = 0; i < b.body->m_nodes.size(); ++i) positions.push_back(json_of(b.body->m_nodes[i].m_x));
  answer.update({{"samples", samples}, {"seconds", seconds}, {"steps", steps}, {"positions_m", positions}});
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: springproof-engine-bullet TASK.json");
  const Json task = Json::parse(std::ifstream(argv[1]));
  const Json model = Json::parse(std::ifstream(task.at("model").get<std::string>()));
  Bullet b;
  (task.at("set_up") == "links" ? make_links : make_deformable)(task, model, b);
  const std::string precision = sizeof(btScalar) == 4 ? ", single precision" : ", double precision";
  Json answer = {{"engine", "Bullet " + std::to_string(btGetVersion() / 100.0).substr(0, 4) + precision}};
  if (!task.at("fields_m").is_null() && b.elastic)
    for (const Json& u : task["fields_m"]) answer["forces_N"].push_back(forces_at(vectors_of(u), b));
  if (task.at("steps") > 0) move(task, model, b, answer);
  std::printf("%s\n", answer.dump().c_str());
  std::exit(std::fflush(stdout));  // the world is not taken apart
} catch (const std::exception& e) {
  std::fprintf(stderr, "springproof-engine-bullet: %s\n", e.what());
  return 1;
}

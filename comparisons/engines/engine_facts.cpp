#include "comparisons/engines/engine_facts.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "comparisons/engines/engine_constants.h"

namespace springproof {
namespace {

constexpr double stated_reach = 1, stated_acceleration = 9.81;
constexpr std::array<double, 2> frame_rates = {60, 240};  // per second

struct KindOfSpring {
  const char* key;
  const char* words;
  std::array<double, 3> share;  ///< inside, on the surface, on an edge of the body; 0: not there
};
constexpr std::array<KindOfSpring, 3> spring_kinds = {{{"k_e", "k_e  cell edge    ", {1, 0.5, 0.25}},
                                                       {"k_f", "k_f  face diagonal", {1, 0.5, 0}},
                                                       {"k_c", "k_c  cube diagonal", {1, 0, 0}}}};
constexpr const char* spring_places[] = {"inside", "surface", "edge"};

double corner_tetrahedron(const EngineFacts& f) { return f.edge * f.edge * f.edge / 6; }

}  // namespace

nlohmann::json json_of(const EngineFacts& f) {
  const BulletNeoHooke bullet = bullet_neo_hooke(f.material);
  nlohmann::json compliance = nlohmann::json::object(), damping = nlohmann::json::array();
  for (std::size_t kind = 0; kind < spring_kinds.size(); ++kind)
    for (std::size_t place = 0; place < 3; ++place)
      if (const double k = f.inner[kind] * spring_kinds[kind].share[place]; k > 0)
        compliance[spring_kinds[kind].key][spring_places[place]] = 1 / k;
  for (const double rate : frame_rates)
    damping.push_back({{"time_step_s", 1 / rate}, {"zeta", implicit_euler_damping(f.frequency, 1 / rate)}});
  return {{"compliance_m_N", compliance},
          {"volume_compliance_m5_N", f.correction > 0
                                         ? nlohmann::json(volume_compliance(corner_tetrahedron(f), f.correction))
                                         : nlohmann::json(nullptr)},
          {"bullet_neo_hooke", {{"mu_Pa", bullet.mu}, {"lambda_Pa", bullet.lambda}}},
          {"implicit_euler", {{"frequency_Hz", f.frequency}, {"damping", damping}}},
          {"single_precision",
           {{"reach_m", stated_reach},
            {"acceleration_m_s2", stated_acceleration},
            {"least_time_step_s", least_single_precision_step(stated_reach, stated_acceleration)}}}};
}

std::string text_of(const EngineFacts& f) {
  std::string out = "\nfor real-time engines (docs/engines.md)\n";
  const auto put = [&]<class... T>(fmt::format_string<T...> text, T&&... values) {
    fmt::format_to(std::back_inserter(out), text, std::forward<T>(values)...);
  };
  if (f.inner[0] > 0 || f.inner[1] > 0 || f.inner[2] > 0)
    put("  compliance 1/k [m/N]  {:>12} {:>12} {:>12}\n", spring_places[0], spring_places[1], spring_places[2]);
  for (std::size_t kind = 0; kind < spring_kinds.size(); ++kind) {
    if (f.inner[kind] <= 0) continue;
    put("    {}  ", spring_kinds[kind].words);
    for (const double share : spring_kinds[kind].share)
      put("{}", share > 0 ? fmt::format(" {:>12.6g}", 1 / (f.inner[kind] * share)) : "");
    out += '\n';
  }
  if (f.correction > 0)
    put("  a constraint on 6 V of a sixth of a cell that adds kappa: 36 V / kappa = {:.6g} m^5/N; tetrahedra lock\n",
        volume_compliance(corner_tetrahedron(f), f.correction));
  const BulletNeoHooke bullet = bullet_neo_hooke(f.material);
  put("  Bullet's neo-Hooke: mu = 4/3 G = {:.6g} Pa, lambda = Lame's + 5/6 G = {:.6g} Pa\n", bullet.mu, bullet.lambda);
  put("  implicit Euler damps {:g} Hz by pi f dt of the critical: {:.3g} at 1/60 s, {:.3g} at 1/240 s\n", f.frequency,
      implicit_euler_damping(f.frequency, 1 / frame_rates[0]), implicit_euler_damping(f.frequency, 1 / frame_rates[1]));
  put("  single precision: steps above sqrt(1.2e-7 |x| / g) = {:.2g} s, at |x| = {:g} m, g = {:g} m/s^2\n",
      least_single_precision_step(stated_reach, stated_acceleration), stated_reach, stated_acceleration);
  return out;
}

}  // namespace springproof

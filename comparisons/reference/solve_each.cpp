#include "comparisons/reference/solve_each.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "comparisons/reference/grid_cost.h"
#include "fem_reference/exchange/exchange.h"
#include "fem_reference/exchange/reference.h"
#include "problem/files/checksum.h"
#include "problem/processes/child.h"

namespace springproof {
namespace {

/// The request of one of its grids, with no other mesh than its own.
fem::Request of_grid(const fem::Request& all, std::size_t number) {
  fem::Request one = all;
  one.grids = {all.grids[number]};
  fem::Discretisation& grid = one.grids.front();
  if (grid.mesh < 0) return one;
  one.meshes = {all.meshes.at(grid.mesh)};
  grid.mesh = 0;
  return one;
}

std::vector<std::size_t> coarsest_first(const fem::Request& request) {
  std::vector<std::size_t> order(request.grids.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> unknowns;
  for (const fem::Discretisation& grid : request.grids) unknowns.push_back(unknowns_of(request, grid));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return unknowns[a] < unknowns[b]; });
  return order;
}

fem::Solution without_result(const fem::Request& request, const std::string& why) {
  fem::Solution none;
  none.grid = request.grids.front();
  none.law = request.law;
  none.message = why;
  return none;
}

/// By all that the program is told.
std::string name_of(const fem::Request& request) {
  std::string bytes;
  nlohmann::json::to_cbor(fem::to_json(request), bytes);
  return "grid-" + checksum(bytes);
}

fem::Solution solve_one(const fem::Request& request, const RunKeeper& keeper) {
  return keeper.run(
      keeper.keeps() ? name_of(request) : "", cost_of(request), [&] { return fem::solve(request).front(); },
      [](const fem::Solution& s) { return fem::to_json(std::vector{s}); },
      [](const nlohmann::json& kept) { return fem::solutions_from_json(kept).front(); });
}

}  // namespace

std::vector<fem::Solution> solve_each(const fem::Request& request, const RunKeeper& keeper, const Solved& solved) {
  std::vector<fem::Solution> solutions(request.grids.size());
  std::map<std::string, std::string> lost;  // elements that the program died of, and how
  std::map<std::pair<std::string, double>, bool> hopeless;
  std::exception_ptr first;
  std::size_t thrown = 0;
  for (const std::size_t g : coarsest_first(request)) {
    if (children_interrupted()) throw std::runtime_error("interrupted");
    fem::Request one = of_grid(request, g);
    const auto& [element, grading] = std::pair(request.grids[g].element, request.grids[g].grading);
    try {
      if (lost.contains(element))
        solutions[g] = without_result(one, lost.at(element)), ++thrown;
      else if (grading != 1 && hopeless[{element, grading}])
        solutions[g] = without_result(one, "not tried, as the coarser grid has no result");
      else
        solutions[g] = solve_one(one, keeper);
    } catch (const NoRoom&) {  // no fault of the case
      throw;
    } catch (const std::runtime_error& e) {
      if (!first) first = std::current_exception();
      lost[element] = e.what();
      solutions[g] = without_result(one, e.what());
      ++thrown;
    }
    solutions[g].grid = request.grids[g];
    hopeless[{element, grading}] |= !solutions[g].ok;
    if (solved && solutions[g].ok) solved(g, solutions[g]);
  }
  if (first && thrown == solutions.size()) std::rethrow_exception(first);
  return solutions;
}

}  // namespace springproof

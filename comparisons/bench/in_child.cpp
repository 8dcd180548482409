#include "comparisons/bench/in_child.h"

#include <nlohmann/json.hpp>

#include "comparisons/bench/interrupt.h"
#include "problem/system/in_child.h"

namespace springproof::bench {

using Json = nlohmann::json;

Json in_child(const std::function<Json()>& work) try {
  throw_if_interrupted();
  const std::string text =
      springproof::in_child([&] { return work().dump(-1, ' ', false, Json::error_handler_t::replace); });
  throw_if_interrupted();
  return Json::parse(text);
} catch (const std::runtime_error&) {
  throw_if_interrupted();  // which ended the child
  throw;
}

}  // namespace springproof::bench

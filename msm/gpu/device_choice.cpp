#include <cstdlib>

#include "msm/gpu/gpu.h"
#include "problem/system/input_error.h"

namespace springproof::gpu {
namespace {

bool choose() {
  const char* wanted = std::getenv("SPRINGPROOF_DEVICE");
  if (!wanted || !*wanted || wanted == std::string("processor")) return false;
  const std::string of = "SPRINGPROOF_DEVICE = \"" + std::string(wanted) + "\" ";
  if (wanted != std::string("gpu")) throw InputError(of + "is unknown (allowed: processor, gpu)");
  if (device_name().empty())
    throw InputError(
        of + "cannot be used here: " + (built_for_gpu() ? "no GPU is found" : "built without SPRINGPROOF_CUDA"));
  return true;
}

}  // namespace

bool wants_gpu() {
  static const bool gpu = choose();
  return gpu;
}

}  // namespace springproof::gpu

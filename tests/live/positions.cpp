// Positions of the nodes of four models of one body after 100 steps under a pull, a load and another material on the
// way, by the native library; positions.js does the same by WebAssembly's.   live_positions DIGITS
#include <cstdio>
#include <cstdlib>

#include "comparisons/live/live.h"

namespace {

constexpr int corners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

void require(int status) {
  if (status == 0) return;
  std::fprintf(stderr, "%s\n", live_message());
  std::exit(1);
}

}  // namespace

int main(int argc, char** argv) {
  const int digits = argc > 1 ? std::atoi(argv[1]) : 64;
  float points[24];
  unsigned short facets[36];
  unsigned char parts[12];
  for (int n = 0; n < 8; ++n)
    for (int d = 0; d < 3; ++d) points[3 * n + d] = (n >> d & 1) ? 0.1f : 0.0f;
  for (int f = 0, i = 0; f < 6; ++f)
    for (const int c : {0, 1, 2, 0, 2, 3}) {
      parts[i / 3] = f == 4 ? 1 : f == 5 ? 2 : 0;
      facets[i++] = static_cast<unsigned short>(corners[f][c]);
    }
  require(live_body(points, 8, facets, parts, 12, 512));
  for (const char* name : {"msm_18", "hybmss", "hybmss_avg", "emsm"}) {
    require(live_model(0, name, 0.3, 1e4, 1000, digits));
    live_load(2, 0, 5);
    live_grab(7);
    live_pull_to(0.11, 0.105, 0.115);
    const double step = live_number(0, live_time_step) / 2;
    int steps = live_advance(0, 49 * step, 3);  // no whole number of steps, which round-off might make one more
    require(live_model(0, name, 0.45, 2e4, 1000, digits));
    while (steps < 100) steps += live_advance(0, step / 4, 3);
    const double* x = live_node_positions(0);
    for (int n = 0; n < 3 * live_nodes(); ++n) std::printf("%.17g\n", x[n]);
  }
}

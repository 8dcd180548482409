"""What a call from Python costs: CPU time of motion.step() beside the same step in a loop of C++, in turns.   overhead.py [TURNS]"""
import statistics
import sys
import time

import springproof as sp

turns = int(sys.argv[1]) if len(sys.argv) > 1 else 200
body = sp.block((0.24, 0.2, 0.2), (24, 20, 20))  # 11025 nodes
for name in ("hybmss_avg", "hybmss", "msm_18", "msm_random"):
    motion = sp.Model(name, body, sp.Material(E=1e6, nu=0.25)).motion([sp.Displacement("x_min"), sp.Gravity((0, 0, -9.81))])
    motion.step(20)
    ratios, python, cpp = [], [], []
    for _ in range(turns):
        start = time.thread_time()
        for _ in range(10):
            motion.step()
        python.append((time.thread_time() - start) / 10)
        cpp.append(motion._seconds_per_step(10))
        ratios.append(python[-1] / cpp[-1])
    quartiles = statistics.quantiles(ratios, n=4)
    print(f"{name:<11} {len(motion.positions)} nodes: {1e6 * statistics.median(python):7.1f} us from Python, {1e6 * statistics.median(cpp):7.1f} us from C++, "
          f"ratio {quartiles[1]:.3f} ({quartiles[0]:.3f} to {quartiles[2]:.3f}), of the least times {min(python) / min(cpp):.3f}; {motion.description}")

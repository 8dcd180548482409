// What run_child() and run_forked() share.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <atomic>

#include "problem/processes/child.h"

namespace springproof {

/// While it lives interrupt_children() signals the process.
class ChildSlot {
 public:
  explicit ChildSlot(pid_t child);
  ~ChildSlot() { slot_ = 0; }
  ChildSlot(const ChildSlot&) = delete;
  ChildSlot& operator=(const ChildSlot&) = delete;

 private:
  std::atomic<pid_t>& slot_;
};

/// How often interrupt_children() has been called.
unsigned interrupt_count();

/// In a child: it is killed when the thread that made it ends, which may have happened already.  Async-signal-safe.
void end_with_parent(pid_t parent);

/// @param status, used of wait4()
ChildEnd end_of(int status, const rusage& used);

}  // namespace springproof

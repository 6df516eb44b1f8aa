#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace dowel {

/// What a child is busy with; named in the reason when it dies.
enum class WorkerStage : std::uint8_t { Start, Read, Transfer, Mesh, Volume, Features, Box };

const char* stage_name(WorkerStage stage);

struct WorkerLimits {
  double max_seconds = 120.0;        ///< processor time of one child; four times that by the clock
  std::size_t max_memory_mb = 4096;  ///< address space that one child may add to its parent's
};

/// How one child ended.
struct WorkerOutcome {
  std::vector<std::byte> output;  ///< what the task returned; empty where it failed
  std::string failure;            ///< one sentence without a full stop; empty where it succeeded
  double seconds = 0.0;
};

/// Runs in the child. Reports each stage as it begins; what it throws becomes `failure`.
using WorkerTask = std::function<std::vector<std::byte>(
    std::size_t index, const std::function<void(WorkerStage)>& report)>;

/// Receives the outcomes in the order of the indices; false: start no more and end those running.
using WorkerDone = std::function<bool(std::size_t index, WorkerOutcome&& outcome)>;

/// Asked several times a second; true: report no more and end those running.
using WorkerStop = std::function<bool()>;

/// Runs `task(i)` for each i in [0, count) in a forked child of its own, `jobs` at a time (at least
/// one). A child has no standard input or output, none of the caller's open files, no core dump; it
/// dies with the caller, and Ctrl-C at the terminal is the caller's alone. Whatever it does (crash,
/// hang, exhaust memory) ends as one outcome. All children are reaped when this returns or throws.
/// Expects: no other thread of the process is running, limits > 0.
/// Throws: what `on_done` throws; Error{FileUnreadable} where no process can be started.
void run_workers(std::size_t count, unsigned jobs, const WorkerLimits& limits,
                 const WorkerTask& task, const WorkerDone& on_done,
                 const WorkerStop& stop = nullptr);

}  // namespace dowel

#include "worker.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"

namespace dowel {
namespace {

using Clock = std::chrono::steady_clock;

// The child's side of the pipe: any number of stage bytes, then one of these and its payload up to
// the end of the stream.
constexpr std::uint8_t kResult = 'R';
constexpr std::uint8_t kOutOfMemory = 'M';
constexpr std::uint8_t kError = 'E';

constexpr int kChildPipe = 3;

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return true;
}

void send_byte(std::uint8_t value) {
  const std::byte byte{value};
  write_all(kChildPipe, std::span(&byte, 1));
}

/// A child is ended after so many times its limit of processor time by the clock.
constexpr double kWallOverCpu = 4.0;

void set_limit(__rlimit_resource resource, std::uint64_t soft, std::uint64_t hard) {
  const rlimit limit{soft, hard};
  ::setrlimit(resource, &limit);
}

void limit_resources(const WorkerLimits& limits) {
  set_limit(RLIMIT_CORE, 0, 0);
  // Processor time, so that a busy machine fails no file; the wall clock ends a child that waits.
  const auto seconds = static_cast<std::uint64_t>(std::ceil(std::min(limits.max_seconds, 1.0e9)));
  set_limit(RLIMIT_CPU, seconds, seconds + 2);
#ifndef DOWEL_SANITIZED  // sanitizers reserve terabytes of addresses
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const std::uint64_t own_bytes = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::uint64_t bytes = own_bytes + (static_cast<std::uint64_t>(limits.max_memory_mb) << 20U);
  set_limit(RLIMIT_AS, bytes, bytes);
#endif
}

/// The caller may have handlers (a prompt's SIGINT) that make no sense here, and a crash must look
/// like one.
void reset_signals() {
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction action {};
    action.sa_handler = SIG_DFL;
    ::sigaction(signal, &action, nullptr);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// Leaves the child with /dev/null as standard streams and the pipe as descriptor 3, nothing else.
bool isolate_descriptors(int pipe) {
  const int null = ::open("/dev/null", O_RDWR);
  if (null < 0) return false;
  // The pipe may itself be one of 0..3: move both out of the way first.
  const int far_pipe = ::fcntl(pipe, F_DUPFD, kChildPipe + 1);
  const int far_null = ::fcntl(null, F_DUPFD, kChildPipe + 1);
  if (far_pipe < 0 || far_null < 0) return false;
#ifdef DOWEL_SANITIZED  // the sanitizer's report is worth more than silence
  constexpr std::array kSilenced{STDIN_FILENO, STDOUT_FILENO};
#else
  constexpr std::array kSilenced{STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
#endif
  for (const int stream : kSilenced) {
    if (::dup2(far_null, stream) < 0) return false;
  }
  if (::dup2(far_pipe, kChildPipe) < 0) return false;
  return ::close_range(kChildPipe + 1, ~0U, 0) == 0;
}

void run_task(std::size_t index, const WorkerTask& task) {
  try {
    const std::vector<std::byte> output =
        task(index, [](WorkerStage stage) { send_byte(static_cast<std::uint8_t>(stage)); });
    send_byte(kResult);
    write_all(kChildPipe, output);
  } catch (const std::bad_alloc&) {
    send_byte(kOutOfMemory);
  } catch (const std::exception& error) {
    send_byte(kError);
    write_all(kChildPipe, std::as_bytes(std::span(error.what(), std::strlen(error.what()))));
  } catch (...) {
    send_byte(kError);
  }
}

/// Never returns and runs no exit handler: the caller's buffers and handlers are the caller's.
[[noreturn]] void run_child(int pipe, pid_t parent, std::size_t index, const WorkerLimits& limits,
                            const WorkerTask& task) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);  // a terminal's Ctrl-C would end the children before the caller has a say
  reset_signals();
  if (::getppid() != parent || !isolate_descriptors(pipe)) ::_exit(1);
  limit_resources(limits);
  run_task(index, task);
  ::_exit(0);
}

/// A running child; killed and reaped when it goes.
class Child {
 public:
  Child(std::size_t index, const WorkerLimits& limits, const WorkerTask& task);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  std::size_t index() const noexcept { return index_; }
  int pipe() const noexcept { return pipe_; }
  Clock::time_point deadline() const noexcept { return deadline_; }

  /// Takes what the pipe holds. The outcome once the child has ended.
  std::optional<WorkerOutcome> receive();
  /// Ends a child that is past its deadline.
  WorkerOutcome time_out();

 private:
  void take(std::span<const std::byte> bytes);
  int reap();
  WorkerOutcome failed(const std::string& what) const;
  WorkerOutcome ended(int status);

  std::size_t index_ = 0;
  WorkerLimits limits_;
  pid_t pid_ = -1;
  int pipe_ = -1;
  Clock::time_point start_;
  Clock::time_point deadline_;
  WorkerStage stage_ = WorkerStage::Start;
  std::uint8_t kind_ = 0;
  std::vector<std::byte> payload_;
};

[[noreturn]] void fail_to_start() {
  throw Error(ErrorCode::FileUnreadable,
              std::string("no import process can be started: ") + std::strerror(errno));
}

Child::Child(std::size_t index, const WorkerLimits& limits, const WorkerTask& task)
    : index_(index), limits_(limits), start_(Clock::now()) {
  const std::chrono::duration<double> allowed(kWallOverCpu * std::min(limits.max_seconds, 1.0e9));
  deadline_ = start_ + std::chrono::duration_cast<Clock::duration>(allowed);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start();
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) run_child(ends[1], parent, index, limits, task);
  // Closed at once: a later child that inherited this end would hold the stream open.
  ::close(ends[1]);
  pipe_ = ends[0];
  if (pid_ < 0) {
    ::close(pipe_);
    fail_to_start();
  }
}

Child::~Child() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    reap();
  }
  ::close(pipe_);
}

int Child::reap() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return status;
}

void Child::take(std::span<const std::byte> bytes) {
  while (kind_ == 0 && !bytes.empty()) {
    const auto value = std::to_integer<std::uint8_t>(bytes.front());
    bytes = bytes.subspan(1);
    if (value <= static_cast<std::uint8_t>(WorkerStage::Box)) {
      stage_ = WorkerStage{value};
    } else {
      kind_ = value;
    }
  }
  payload_.insert(payload_.end(), bytes.begin(), bytes.end());
}

WorkerOutcome Child::failed(const std::string& what) const {
  const std::chrono::duration<double> elapsed = Clock::now() - start_;
  return {.output = {}, .failure = what, .seconds = elapsed.count()};
}

std::string shown(double number) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", number);
  return text.data();
}

WorkerOutcome Child::ended(int status) {
  const std::string where = std::string(" in ") + stage_name(stage_);
  const std::string out_of_time = "time limit of " + shown(limits_.max_seconds) + " s reached";
  if (kind_ == kResult && WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    WorkerOutcome outcome = failed("");
    outcome.output = std::move(payload_);
    return outcome;
  }
  if (kind_ == kOutOfMemory) {
    return failed("memory limit of " + std::to_string(limits_.max_memory_mb) + " MB reached" +
                  where);
  }
  if (kind_ == kError) {
    const std::string message(reinterpret_cast<const char*>(payload_.data()), payload_.size());
    return failed(message.empty() ? "unknown exception" + where : message);
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return failed(out_of_time + where);
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) return failed("interrupted" + where);
  if (WIFSIGNALED(status)) {
    const char* signal = ::sigabbrev_np(WTERMSIG(status));
    return failed("reader crashed (SIG" + std::string(signal ? signal : "?") + ")" + where);
  }
  return failed("reader ended without a result (exit code " +
                std::to_string(WIFEXITED(status) ? WEXITSTATUS(status) : -1) + ")" + where);
}

std::optional<WorkerOutcome> Child::receive() {
  std::array<std::byte, 1U << 16U> chunk{};
  const ssize_t count = ::read(pipe_, chunk.data(), chunk.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return std::nullopt;
  if (count <= 0) return ended(reap());
  take(std::span(chunk).first(static_cast<std::size_t>(count)));
  if (payload_.size() >> 20U >= limits_.max_memory_mb) {
    ::kill(pid_, SIGKILL);
    reap();
    return failed("memory limit of " + std::to_string(limits_.max_memory_mb) +
                  " MB reached by the result");
  }
  return std::nullopt;
}

WorkerOutcome Child::time_out() {
  ::kill(pid_, SIGKILL);
  reap();
  return failed("time limit of " + shown(limits_.max_seconds) + " s reached in " +
                stage_name(stage_));
}

/// Time until the first deadline for `poll`, rounded up so that it does not spin before it.
int poll_timeout_ms(const std::vector<std::unique_ptr<Child>>& children, bool can_stop) {
  Clock::time_point first = Clock::time_point::max();
  for (const auto& child : children) first = std::min(first, child->deadline());
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(first - Clock::now()).count();
  const decltype(left) longest_ms = can_stop ? 100 : 3'600'000;
  return static_cast<int>(std::clamp<decltype(left)>(left, 0, longest_ms));
}

/// Waits until at least one child has something to say or is late; moves those that ended into
/// `outcomes`.
void collect(std::vector<std::unique_ptr<Child>>& children,
             std::map<std::size_t, WorkerOutcome>& outcomes, bool can_stop) {
  std::vector<pollfd> polled;
  polled.reserve(children.size());
  for (const auto& child : children) polled.push_back({child->pipe(), POLLIN, 0});
  const int ready = ::poll(polled.data(), polled.size(), poll_timeout_ms(children, can_stop));
  for (std::size_t i = children.size(); i-- > 0;) {
    std::optional<WorkerOutcome> outcome;
    if (ready > 0 && polled[i].revents != 0) outcome = children[i]->receive();
    if (!outcome && Clock::now() >= children[i]->deadline()) outcome = children[i]->time_out();
    if (!outcome) continue;
    outcomes.emplace(children[i]->index(), std::move(*outcome));
    children.erase(children.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace

const char* stage_name(WorkerStage stage) {
  switch (stage) {
    case WorkerStage::Start:
      return "start";
    case WorkerStage::Read:
      return "read";
    case WorkerStage::Transfer:
      return "transfer";
    case WorkerStage::Mesh:
      return "mesh";
    case WorkerStage::Volume:
      return "volume";
    case WorkerStage::Features:
      return "features";
    case WorkerStage::Box:
      return "box";
  }
  return "unknown stage";
}

void run_workers(std::size_t count, unsigned jobs, const WorkerLimits& limits,
                 const WorkerTask& task, const WorkerDone& on_done, const WorkerStop& stop) {
  DOWEL_EXPECTS(limits.max_seconds > 0.0 && limits.max_memory_mb > 0);
  // Outcomes wait for those before them: do not run so far ahead that they fill the memory.
  constexpr std::size_t kMostWaiting = 64;
  std::vector<std::unique_ptr<Child>> children;
  std::map<std::size_t, WorkerOutcome> outcomes;
  std::size_t next_to_start = 0;
  std::size_t next_to_report = 0;
  while (next_to_report < count) {
    if (stop && stop()) return;
    while (next_to_start < count && children.size() < std::max(jobs, 1U) &&
           next_to_start < next_to_report + kMostWaiting) {
      children.push_back(std::make_unique<Child>(next_to_start, limits, task));
      ++next_to_start;
    }
    collect(children, outcomes, stop != nullptr);
    for (auto first = outcomes.begin(); first != outcomes.end() && first->first == next_to_report;
         first = outcomes.begin()) {
      WorkerOutcome outcome = std::move(first->second);
      outcomes.erase(first);
      // What stops the caller may have ended the child, too: then its outcome says nothing.
      if (stop && stop()) return;
      if (!on_done(next_to_report++, std::move(outcome))) return;
    }
  }
}

}  // namespace dowel

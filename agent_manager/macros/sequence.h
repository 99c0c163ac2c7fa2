#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "agent_manager/macros/macro.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// What all runs of macros share. Outlives every run.
struct MacroServices {
  vm::Scheduler& clock;
  Hub& hub;
  vm::SlotMachine& slots;  ///< of @AM-MCL
  std::function<void(const std::string& path)> remove_file;
  Variables kept{};  ///< variables that outlive runs
  /// The last report of each slot whose last value counts for some macro, by module and slot; none
  /// is longer than what it is compared to.
  std::map<std::pair<std::string, std::string>, std::string> last{};
  bool lockstep = false;
};

/// What the sequences of one run share. Outlives them.
struct RunState {
  std::shared_ptr<const Macro> macro;
  Origin origin;                     ///< on whose behalf its messages are sent
  std::set<std::string> involved{};  ///< modules it sent to; if one leaves, the run fails
  std::vector<const MirrorStep*> mirrors{};
  std::size_t variable_bytes = 0;  ///< of all its sequences
};

/// Executes a list of steps, one after the other. A step that waits returns to the hub's loop; the
/// answer, report or timer it waits for continues the list.
/// Lifetime: the last shared_ptr cancels it: no later step is executed and OnEnd is not called.
/// Thread: the scheduler's.
/// Limits: kMaxVariableBytes for all sequences of a run, kMaxBranches at a time; of the reports it
/// has heard, the latest kMaxHeardBytes are remembered.
/// Errors: the first step that fails ends it, unless it is lenient; OnEnd gets the error.
class Sequence : public std::enable_shared_from_this<Sequence> {
 public:
  static constexpr std::size_t kMaxVariableBytes = 1u << 20;
  static constexpr std::size_t kMaxHeardBytes = 256u << 10;
  static constexpr std::size_t kMaxBranches = 64;
  /// Messages of all runs that one peer has started, and that the hub has not dealt with; beyond
  /// them the run fails.
  static constexpr std::size_t kMaxSaid = 4096;
  /// Called once, from the hub's queue. `error` is the failure of a step.
  using OnEnd = std::function<void(const std::optional<vm::Error>& error)>;
  /// `lenient`: a step that fails is skipped.
  Sequence(MacroServices& services, RunState& run, std::shared_ptr<const Steps> steps,
           Variables variables, bool lenient, OnEnd on_end);
  ~Sequence();
  Sequence(const Sequence&) = delete;

  void Start() { Advance(); }
  /// `told`: an event (`tell`), not the report of a slot's value.
  void OnReport(const std::string& from, const std::string& slot, const std::string& value,
                bool told);
  const Variables& variables() const { return variables_; }
  static std::size_t BytesOf(const Variables& variables);

 private:
  struct Heard {
    std::string from, slot, value;
  };
  struct Waiting {
    const WaitStep* step;
    vm::Time limit;
  };
  void Advance();
  bool Holds(const MacroStep& step) const;
  bool Blocked() const;
  // One for each kind of step.
  void Do(const SendStep& step);
  void Do(const RequestStep& step);
  void Do(const WaitStep& step);
  void Do(const FollowStep& step) { followers_.push_back(&step); }
  void Do(const MirrorStep& step) { run_.mirrors.push_back(&step); }
  void Do(const ReportStep& step);
  void Do(const StoreStep& step);
  void Do(const PauseStep& step);
  void Do(const LetStep& step);
  void Do(const StartStep& step);
  void Do(const NeedStep& step);
  void Do(const RemoveStep& step);
  void Do(const MarkStep&) { ForgetHeard(); }
  void Do(const BranchesStep& step);
  void Branch(const std::vector<std::shared_ptr<const Steps>>& branches);
  void OnBranchEnd(std::size_t index, const std::optional<vm::Error>& error);

  std::string Value(const std::string& name) const;
  std::optional<std::string> Expanded(const Template& text);
  bool Let(const std::string& name, std::string value);
  void Say(const MessageTemplate& message, const Template::Lookup& lookup, OnAnswer done);
  void Answered(unsigned number, const std::string& where, const vm::Result<std::string>& answer);
  /// True if the wait is over.
  bool Meets(const WaitStep& step, const Heard& heard);
  void Hear(Heard heard);
  void ForgetHeard();
  void After(vm::Time delay, void (Sequence::*then)());
  void WaitedTooLong();
  void Fail(vm::Error error);
  void End(std::optional<vm::Error> error);

  MacroServices& services_;
  RunState& run_;
  const std::shared_ptr<const Steps> steps_;
  Variables variables_;
  const bool lenient_;
  OnEnd on_end_;
  Origin origin_;
  std::size_t next_ = 0;
  bool ended_ = false;
  std::deque<Heard> heard_;  // since the start or the last MarkStep
  std::size_t heard_bytes_ = 0;
  std::vector<const FollowStep*> followers_;
  std::optional<Waiting> waiting_;
  std::optional<unsigned> asking_;  // the number of the request under way
  unsigned asked_ = 0;
  vm::TimerId timer_ = 0;
  std::vector<std::shared_ptr<Sequence>> branches_;
  std::size_t open_branches_ = 0;
};

}  // namespace am

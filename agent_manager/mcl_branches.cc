// Steps of a macro that go on side by side: each branch is a run of its own, and the run it belongs
// to goes on when all of them have ended.

#include <utility>

#include "agent_manager/mcl_run.h"

namespace am {

void Mcl::StartBranches(Run& run, const std::vector<const std::vector<MacroStep>*>& branches) {
  const unsigned long parent = run.id;
  std::vector<unsigned long> ids;
  for (const auto* steps : branches) {
    // The name cannot be a slot's, so no macro is taken for a branch.
    auto macro = std::make_shared<Macro>();
    macro->name = run.macro->name + "/" + std::to_string(++last_run_);
    macro->steps = *steps;
    const unsigned long id = last_run_;
    runs_[id].reset(new Run{.id = id,
                            .macro = std::move(macro),
                            .variables = run.variables,
                            .heard = run.heard,
                            .followers = {},
                            .asking = {},
                            .involved = {},
                            .error = {},
                            .reply = vm::Reply([](vm::Result<std::string>) {}),
                            .stop_replies = {},
                            .parent = parent,
                            .branches = {},
                            .successor = {}});
    run.branches.insert(id);
    ids.push_back(id);
  }
  // All of them are there before the first begins: one that ends at once must not end the run.
  for (const unsigned long id : ids) {
    if (Run* branch = Find(id)) Advance(*branch);
  }
}

void Mcl::FinishBranch(Run& branch) {
  const std::unique_ptr<Run> ended = std::move(runs_.at(branch.id));
  runs_.erase(ended->id);
  Run* parent = Find(ended->parent);
  if (parent == nullptr || parent->branches.erase(ended->id) == 0) return;
  // What it set is known to the steps that follow; what two branches set, to the one that ended
  // last.
  for (auto& [name, value] : ended->variables) parent->variables[name] = std::move(value);
  for (const std::string& module : ended->involved) parent->involved.insert(module);
  if (!parent->branches.empty()) return;
  parent->timer = clock_.Post([this, id = parent->id] {
    Run* run = Find(id);
    if (run == nullptr) return;
    run->timer = 0;
    Advance(*run);
  });
}

void Mcl::FailBranch(Run& branch, vm::Error error) {
  Run* root = &branch;
  while (root->parent != 0) root = Find(root->parent);
  if (root->phase == Run::Phase::kSteps) return Fail(*Find(branch.parent), std::move(error));
  // Stopping goes on regardless. From the loop: the caller may be in the middle of this branch.
  branch.waiting = nullptr;
  branch.asking.reset();
  clock_.Cancel(branch.timer);
  branch.timer = clock_.Post([this, id = branch.id] {
    if (Run* failed = Find(id)) FinishBranch(*failed);
  });
}

void Mcl::EndBranches(Run& run) {
  for (const unsigned long id : std::exchange(run.branches, {})) {
    Run* branch = Find(id);
    if (branch == nullptr) continue;
    EndBranches(*branch);
    for (const std::string& module : branch->involved) run.involved.insert(module);
    clock_.Cancel(branch->timer);
    branch->waiting = nullptr;
    branch->asking.reset();
    // From the loop: the caller may be in the middle of this branch.
    branch->timer = clock_.Post([this, id] { runs_.erase(id); });
  }
}

}  // namespace am

#pragma once

#include "task_manager/interpreter/dialog_session.h"

namespace vxml {

/// An anonymous scope for the time of a block, a handler or a filled.
class DialogSession::ScopeGuard {
 public:
  explicit ScopeGuard(DialogSession& session)
      : session_(session), node_(session.active_node_), depth_(session.anonymous_.size()) {
    session_.anonymous_.push_back(session_.engine_.NewScope());
  }
  ~ScopeGuard() {
    session_.anonymous_.resize(depth_);
    session_.active_node_ = node_;
  }
  ScopeGuard(const ScopeGuard&) = delete;
  ScopeGuard& operator=(const ScopeGuard&) = delete;
  script::Value& scope() { return session_.anonymous_.back(); }

 private:
  DialogSession& session_;
  const vm::xml::Node* node_;
  std::size_t depth_;
};

}  // namespace vxml

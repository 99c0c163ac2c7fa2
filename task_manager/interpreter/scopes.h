#pragma once

#include <map>
#include <string>
#include <vector>

#include "task_manager/interpreter/budget.h"
#include "task_manager/interpreter/position.h"
#include "task_manager/interpreter/signals.h"
#include "task_manager/script/engine.h"

namespace vxml {

/// The variables of a session and their scopes, from the outermost in: session, application,
/// document, dialog, and anonymous ones of blocks and handlers (VoiceXML 2.0 section 5.1.2).
/// Errors of scripts are thrown as error.semantic, or error.noresource over a limit.
/// Thread: the session's. The engine and the position outlive it.
class Scopes {
 public:
  class Block;
  /// The scopes below the session's: what a subdialog has of its own.
  struct Frame {
    script::Value names;  ///< an object that has the scopes by their names
    script::Value application;
    script::Value document;
    script::Value dialog;  ///< invalid while no dialog runs
    std::vector<script::Value> blocks;
  };

  static constexpr std::size_t kMaxEventName = 1000;  ///< bytes

  Scopes(script::Engine& engine, const Position& position, Budget& budget)
      : engine_(engine), position_(position), budget_(budget) {}

  /// Makes the read-only session scope of variables by their paths ("connection.remote.uri").
  void MakeSession(const std::map<std::string, std::string>& variables);
  void EnterApplication();
  /// A root document is run in the application scope itself.
  void EnterDocument(bool is_root);
  void EnterDialog();
  void LeaveDialog();
  void LeaveBlocks() { frame_.blocks.clear(); }
  Frame Exchange(Frame frame) { return std::exchange(frame_, std::move(frame)); }
  bool HasApplication() const { return frame_.application.valid(); }

  script::Value Evaluate(const vm::xml::Node& node, const std::string& expression);
  /// Throws what a failure of the engine is: error.noresource over a limit, else error.semantic.
  [[noreturn]] void Throw(const vm::xml::Node& node, const std::string& what,
                          const vm::Error& error) const;
  /// The attribute's expression as a truth; true without one.
  bool Condition(const vm::xml::Node& node, const std::string& attribute = "cond");
  std::string Text(const vm::xml::Node& node, const std::string& expression);
  /// What an attribute says, or the expression in its twin (src, srcexpr), which wins.
  std::string Text(const vm::xml::Node& node, const char* attribute, const char* twin);
  /// Text and <value> inside the element.
  std::string ContentText(const vm::xml::Node& node);
  /// The event that event, eventexpr, message and messageexpr of the element name.
  EventThrown Event(const vm::xml::Node& node);
  void Run(const vm::xml::Node& node, const std::string& script);

  /// Into the innermost scope.
  void Declare(const vm::xml::Node& node, const std::string& name, const script::Value& value);
  bool IsDeclaredInnermost(const std::string& name);
  /// Sets a variable that was declared and is not the session's.
  void Assign(const vm::xml::Node& node, const std::string& name, const script::Value& value);
  /// <clear>: sets a variable that was declared to undefined.
  void Clear(const vm::xml::Node& node, const std::string& name);

  /// Declares a form item variable: cleared_items() tells when it becomes undefined.
  void DeclareItem(const vm::xml::Node& node, const std::string& name, const script::Value& value);
  std::uint64_t cleared_items() const { return engine_.cleared(); }
  /// Variables of the dialog scope.
  void Store(const std::string& name, const script::Value& value);
  script::Value Get(const std::string& name) const;
  /// application.lastresult$
  void SetLastResult(const script::Value& result);
  script::Value last_result() const;

 private:
  script::Chain Chain() const;
  bool IsDeclared(const std::string& name);
  bool IsOfSession(const std::string& name);
  void RequireDeclared(const vm::xml::Node& node, const std::string& name);
  void RequireIdentifier(const vm::xml::Node& node, const std::string& name);

  script::Engine& engine_;
  const Position& position_;
  Budget& budget_;  ///< each evaluation may take long, so it is looked at before
  script::Value session_;
  Frame frame_;
};

/// An anonymous scope for the time of a block, a handler or a <filled>.
class Scopes::Block {
 public:
  explicit Block(Scopes& scopes) : scopes_(scopes), depth_(scopes.frame_.blocks.size()) {
    scopes_.frame_.blocks.push_back(scopes_.engine_.NewScope());
  }
  ~Block() { scopes_.frame_.blocks.resize(depth_); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
  void Set(const std::string& name, const script::Value& value) {
    scopes_.engine_.Set(scopes_.frame_.blocks.back(), name, value);
  }

 private:
  Scopes& scopes_;
  std::size_t depth_;
};

}  // namespace vxml

#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

// clang-format off
/// Where agents, modules and slots stand in a broker's tree of topics:
///
///     ROOT/AGENT/$state            retained: ONLINE, OFFLINE (it has stopped), LOST (its last will)
///     ROOT/AGENT/$hub              retained: which process is this agent, so that no second one is
///     ROOT/AGENT/$modules          retained: the modules that can be spoken to
///     ROOT/AGENT/$reply            answers for this agent's own requests
///     ROOT/AGENT/$do/MODULE        a command: one line of the protocol without `to` and `from`
///     ROOT/AGENT/MODULE/$state     retained: LIVE, or GONE and why
///     ROOT/AGENT/MODULE/SLOT       retained: the value the module has reported last
///     ROOT/AGENT/MODULE/$tell      an event
///     ROOT/AGENT/MODULE/$error     a refusal nobody waits for
///     ROOT/AGENT/MODULE/SLOT/set   a command: the new value
///     ROOT/AGENT/MODULE/SLOT/inq   a command: a question
///
/// No name of ours holds a '/', '+', '#' or '$', so nothing can be taken for something else.
// clang-format on
namespace am::mqtt {

struct Topic {
  enum class Kind {
    kState,
    kHub,
    kModules,
    kReply,
    kDo,
    kModuleState,
    kSlot,
    kTell,
    kError,
    kSet,
    kInq
  };
  Kind kind = Kind::kState;
  std::string agent;
  std::string module;  ///< from kDo on
  std::string slot;    ///< kSlot, kSet, kInq
  bool operator==(const Topic&) const = default;
};

std::string FormatTopic(std::string_view root, const Topic& topic);
/// kSyntax: outside the tree, or a name that is none; the text has the topic and what was expected.
vm::Result<Topic> ParseTopic(std::string_view root, std::string_view topic);

/// The tree of one agent.
struct AgentTopics {
  std::string root, agent;
  std::string Path(Topic::Kind kind, const std::string& module = "",
                   const std::string& slot = "") const {
    return FormatTopic(root, {kind, agent, module, slot});
  }
};

/// A module of another agent, as `to @AGENT/MODULE` names it. Both empty if it is no such name.
struct RemoteName {
  std::string agent, module;
};
RemoteName SplitRemoteName(std::string_view name);

}  // namespace am::mqtt

#include "agent_manager/mqtt/topics.h"

#include <vector>

#include "vm_protocol/core/message.h"
#include "vm_protocol/core/utf8.h"

namespace am::mqtt {

using vm::Errc;
using vm::Fail;
using vm::Result;
using Kind = Topic::Kind;

namespace {

constexpr std::size_t kShownBytes = 100;

std::vector<std::string_view> Levels(std::string_view text) {
  std::vector<std::string_view> levels;
  while (true) {
    const std::size_t end = text.find('/');
    levels.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return levels;
    text.remove_prefix(end + 1);
  }
}

}  // namespace

std::string FormatTopic(std::string_view root, const Topic& topic) {
  const std::string agent = std::string(root) + "/" + topic.agent;
  const std::string module = agent + "/" + topic.module;
  switch (topic.kind) {
    case Kind::kState:
      return agent + "/$state";
    case Kind::kHub:
      return agent + "/$hub";
    case Kind::kModules:
      return agent + "/$modules";
    case Kind::kReply:
      return agent + "/$reply";
    case Kind::kDo:
      return agent + "/$do/" + topic.module;
    case Kind::kModuleState:
      return module + "/$state";
    case Kind::kSlot:
      return module + "/" + topic.slot;
    case Kind::kTell:
      return module + "/$tell";
    case Kind::kError:
      return module + "/$error";
    case Kind::kSet:
      return module + "/" + topic.slot + "/set";
    case Kind::kInq:
      return module + "/" + topic.slot + "/inq";
  }
  return "";
}

Result<Topic> ParseTopic(std::string_view root, std::string_view text) {
  const auto wrong = [&](const std::string& expected) {
    return Fail(Errc::kSyntax, "found the topic '" + vm::ShownUtf8(vm::CutUtf8(text, kShownBytes)) +
                                   "', expected " + expected);
  };
  if (!text.starts_with(root) || text.substr(root.size()).empty() || text[root.size()] != '/')
    return wrong("one below " + std::string(root) + "/");
  const auto levels = Levels(text.substr(root.size() + 1));
  Topic topic;
  topic.agent = levels[0];
  if (!vm::IsModuleName(topic.agent)) return wrong("an agent's name: letters, digits, '_' or '-'");
  if (levels.size() == 2) {
    for (const auto& [word, kind] : {std::pair{"$state", Kind::kState},
                                     {"$hub", Kind::kHub},
                                     {"$modules", Kind::kModules},
                                     {"$reply", Kind::kReply}}) {
      if (levels[1] != word) continue;
      topic.kind = kind;
      return topic;
    }
    return wrong("$state, $hub, $modules or $reply below an agent");
  }
  if (levels.size() < 2 || levels.size() > 4) return wrong("AGENT/MODULE/SLOT");
  const bool command = levels[1] == "$do";
  topic.module = levels[command ? 2 : 1];
  if (!vm::IsModuleName(topic.module)) return wrong("a module's name: letters, digits, '_' or '-'");
  if (command) {
    if (levels.size() != 3) return wrong("AGENT/$do/MODULE");
    topic.kind = Kind::kDo;
    return topic;
  }
  if (levels.size() == 3) {
    for (const auto& [word, kind] : {std::pair{"$state", Kind::kModuleState},
                                     {"$tell", Kind::kTell},
                                     {"$error", Kind::kError}}) {
      if (levels[2] != word) continue;
      topic.kind = kind;
      return topic;
    }
    topic.kind = Kind::kSlot;
  } else if (levels[3] == "set" || levels[3] == "inq") {
    topic.kind = levels[3] == "set" ? Kind::kSet : Kind::kInq;
  } else {
    return wrong("set or inq below a slot");
  }
  topic.slot = levels[2];
  if (!vm::IsSlotName(topic.slot)) return wrong("a slot's name");
  return topic;
}

RemoteName SplitRemoteName(std::string_view name) {
  const std::size_t slash = name.find('/');
  if (slash == std::string_view::npos) return {};
  const std::string_view agent = name.substr(0, slash), module = name.substr(slash + 1);
  // What is subscribed to is made of it: a '+' or '#' would be everybody's reports.
  if (!vm::IsModuleName(agent) || !vm::IsModuleName(module)) return {};
  return {std::string(agent), std::string(module)};
}

}  // namespace am::mqtt

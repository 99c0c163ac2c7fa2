#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "vm_protocol/core/message.h"

namespace stack {

/// The hub with its modules, started from a configuration made for one test, typed at by its
/// console. Everything it says is kept in order for the checks.
class Stack {
 public:
  struct Module {
    std::string name;
    std::vector<std::string> command;
    std::string more;  ///< further JSON members, each with a leading comma
  };

  Stack(const std::string& clock, const std::vector<Module>& modules,
        const std::string& more_config = "") {
    std::ofstream config(folder_ / "config.json");
    config << "{\"clock\": \"" << clock << "\", \"modules\": [";
    for (std::size_t i = 0; i < modules.size(); ++i) {
      config << (i > 0 ? "," : "") << "{\"name\": \"" << modules[i].name << "\", \"command\": [";
      for (std::size_t k = 0; k < modules[i].command.size(); ++k) {
        config << (k > 0 ? "," : "") << "\"" << modules[i].command[k] << "\"";
      }
      config << "]" << modules[i].more << "}";
    }
    config << "]" << more_config << "}";
    config.close();
    hub_ = std::make_unique<support::Process>(
        std::vector<std::string>{GALATEA_BIN_DIR "/agent_manager", "--config",
                                 folder_ / "config.json", "--log", folder_ / "session.log"},
        support::Process::Options{.cwd = folder_.path(), .env = {}});
  }

  void Say(const std::string& line) { hub_->WriteLine(line); }
  support::Process& hub() { return *hub_; }
  std::string operator/(const std::string& name) const { return folder_ / name; }

  /// Ends the console's input and takes everything said until the end.
  std::vector<std::string> Finish() {
    hub_->CloseInput();
    auto lines = hub_->ReadAll(std::chrono::seconds(120));
    EXPECT_EQ(hub_->Wait(), 0) << hub_->ErrorText();
    return lines;
  }

  std::string Log() const { return Text("session.log"); }
  std::string Text(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

 private:
  support::TempDir folder_;
  std::unique_ptr<support::Process> hub_;
};

inline Stack::Module Voice(const std::string& program = "ssm_stub",
                           std::vector<std::string> options = {}) {
  std::vector<std::string> command{GALATEA_BIN_DIR "/" + program};
  command.insert(command.end(), options.begin(), options.end());
  return {"SSM", command, ""};
}
inline Stack::Module Face() {
  return {"FSM", {GALATEA_BIN_DIR "/fsm", "--headless", "--size", "64x48"}, ""};
}

/// The value of the last `rep SLOT = VALUE` (with any tag, from anybody) among the lines; "" if
/// none.
inline std::string Last(const std::vector<std::string>& lines, const std::string& from,
                        const std::string& slot) {
  std::string value;
  for (const std::string& line : lines) {
    const auto message = vm::ParseMessage(line);
    if (message && message->from == from && message->slot == slot) value = message->value;
  }
  return value;
}

}  // namespace stack

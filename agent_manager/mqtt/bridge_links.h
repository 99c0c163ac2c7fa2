#pragma once

#include <string>
#include <utility>

#include "agent_manager/mqtt/bridge.h"

/// What the hub holds of the bridge's peers. Shared by the files that make up the bridge.
namespace am::mqtt {

/// What @MQTT hears. It has no backlog of its own: what the broker does not take in time is
/// replaced by its latest value, or dropped and counted.
class Bridge::GatewayLink final : public Link {
 public:
  explicit GatewayLink(Bridge& bridge) : bridge_(bridge) {}
  void Send(const Outgoing& outgoing) override { bridge_.OnOurMessage(outgoing.message()); }
  void Close() override {}

 private:
  Bridge& bridge_;
};

/// What a module of another agent is sent.
class Bridge::RemoteLink final : public Link {
 public:
  RemoteLink(Bridge& bridge, std::string name) : bridge_(bridge), name_(std::move(name)) {}
  void Send(const Outgoing& outgoing) override { bridge_.SendToRemote(name_, outgoing.message()); }
  void Close() override { bridge_.RemoteGone(name_); }
  std::size_t backlog_bytes() const override {
    const auto remote = bridge_.remotes_.find(name_);
    return remote == bridge_.remotes_.end() ? 0 : remote->second.bytes;
  }

 private:
  Bridge& bridge_;
  const std::string name_;
};

}  // namespace am::mqtt

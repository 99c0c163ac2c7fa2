#include "agent_manager/session/listeners.h"

#include <algorithm>
#include <stdexcept>

#include "agent_manager/session/stream_link.h"

namespace am {

Listeners::Listeners(boost::asio::io_context& io, Hub& hub, OnNotice on_notice, OnNotice on_refusal)
    : io_(io), hub_(hub), on_notice_(std::move(on_notice)), on_refusal_(std::move(on_refusal)) {}

Listeners::Open Listeners::OpenMissing(const std::vector<ListenConfig>& wanted) {
  Open opened;
  for (const ListenConfig& listen : wanted) {
    if (std::ranges::any_of(open_, [&](const auto& open) { return open.first == listen; }))
      continue;
    const auto endpoint = vm::ParseEndpoint(listen.at);
    if (!endpoint) throw std::runtime_error("listen: " + endpoint.error().text);
    const Role role = listen.role.value_or(
        endpoint->kind == vm::Endpoint::Kind::kUnix ? Role::kClient : Role::kGuest);
    opened.emplace_back(
        listen, vm::Acceptor::Open(
                    io_, *endpoint, listen.credentials, vm::Framing::kAuto, vm::Encoding::kUtf8,
                    [this, role](const vm::Acceptor::Connection& connection) {
                      OnConnection(connection, role);
                    },
                    on_refusal_));
  }
  return opened;
}

void Listeners::Commit(const std::vector<ListenConfig>& wanted, Open opened) {
  std::erase_if(open_, [&](const auto& open) {
    return std::ranges::find(wanted, open.first) == wanted.end();
  });
  for (auto& open : opened) {
    on_notice_("listening on " + vm::FormatEndpoint(open.second->endpoint()));
    open_.push_back(std::move(open));
  }
}

void Listeners::OnConnection(const vm::Acceptor::Connection& connection, Role role) {
  const auto& stream = connection.stream;
  const auto key = hub_.Attach(std::make_unique<StreamLink>(stream), PeerKind::kClient, role, "",
                               Dialect::kAuto);
  if (!key) return on_refusal_(connection.from + ": " + key.error().text);
  stream->Start([this, peer = *key](
                    vm::Result<std::string_view> line) { hub_.Receive(peer, std::move(line)); },
                [this, peer = *key](const vm::StreamEnd& end) {
                  if (end.orderly) return hub_.EndInput(peer);
                  on_notice_("@" + hub_.directory().NameOf(peer) + ": " + end.reason);
                  hub_.Leave(peer, end.reason);
                });
  stream->ResumeReading();
}

}  // namespace am

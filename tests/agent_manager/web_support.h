#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/agent_manager/programs.h"
#include "tests/support/process.h"

namespace web_support {

using support::Process;
using support::SocketClient;

inline const std::string kToken = "sixteen-bytes-or-more";

/// A hub with a page, and a face, an ear and a voice that have neither engine nor renderer.
class WebTest : public testing::Test {
 protected:
  WebTest() {
    const std::string token = folder_ / "token", config = folder_ / "config.json";
    std::ofstream(token) << kToken << "\n";
    chmod(token.c_str(), 0600);
    std::ofstream(config) << "{\"listen\": [{\"at\": \"unix:" << folder_ / "hub"
                          << "\", \"role\": \"owner\"}], \"web\": {\"at\": \"tcp:127.0.0.1:0\", "
                             "\"role\": \"owner\", \"token_file\": \""
                          << token
                          << "\"}, \"modules\": [{\"name\": \"FSM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR
        "/tests/agent_manager/fake_face.py\"]}, {\"name\": \"SRM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR
        "/tests/agent_manager/fake_ear.py\"]}, {\"name\": \"SSM\", \"command\": [\"python3\", \""
                          << GALATEA_SOURCE_DIR "/tests/agent_manager/fake_voice.py\"]}]}";
    hub_ = std::make_unique<Process>(std::vector<std::string>{kHub, "--config", config});
    EXPECT_TRUE(hub_->ExpectError("/?token=")) << hub_->ErrorText();
    const std::string text = hub_->ErrorText();
    host_ = text.substr(text.find("http://") + 7);
    host_ = host_.substr(0, host_.find('/'));
    port_ = static_cast<unsigned short>(std::atoi(host_.c_str() + host_.find(':') + 1));
  }
  /// Says a request with these header lines and returns the open connection.
  std::unique_ptr<SocketClient> Open(const std::string& target, const std::string& headers) {
    auto client = SocketClient::Tcp(port_);
    client->Write("GET " + target + " HTTP/1.1\r\n" + headers + "\r\n");
    return client;
  }
  std::string Host() const { return "Host: " + host_ + "\r\n"; }
  std::string CookieName() const { return "galatea_token_" + std::to_string(port_); }
  std::string Cookie() const { return "Cookie: other=1; " + CookieName() + "=" + kToken + "\r\n"; }
  std::string StatusOf(const std::string& target, const std::string& headers) {
    const auto line = Open(target, headers)->ReadLine();
    return line && line->size() > 12 ? line->substr(9, 3) : "nothing";
  }
  static std::string Socket(const std::string& origin) {
    return "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
           (origin.empty() ? "" : "Origin: " + origin + "\r\n");
  }
  /// A text frame; the mask is zero, which leaves the text as it is.
  static std::string Frame(const std::string& text) {
    std::string frame = "\x81";
    if (text.size() < 126) {
      frame += static_cast<char>(0x80 | text.size());
    } else {
      const bool wide = text.size() > 0xffff;
      frame += static_cast<char>(0x80 | (wide ? 127 : 126));
      for (int i = wide ? 7 : 1; i >= 0; --i)
        frame += static_cast<char>(text.size() >> (8 * i) & 0xff);
    }
    return frame + std::string(4, '\0') + text;
  }

  support::TempDir folder_;
  std::unique_ptr<Process> hub_;
  std::string host_;
  unsigned short port_ = 0;
};

/// The browser of this machine; nullptr where it has none.
inline const char* Chromium() {
  for (const char* name : {"chromium", "chromium-headless-shell"}) {
    if (std::system(("command -v " + std::string(name) + " >/dev/null").c_str()) == 0) return name;
  }
  return nullptr;
}

/// A port nobody listens at now.
inline unsigned short FreePort() {
  const int probe = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ::bind(probe, reinterpret_cast<const sockaddr*>(&address), size);
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(probe);
  return ntohs(address.sin_port);
}

/// A hub whose page has no token of the configuration's.
struct PlainHub {
  PlainHub(const std::string& state, unsigned short port)
      : hub({kHub, "--web", std::to_string(port)},
            {.cwd = "", .env = {"XDG_STATE_HOME=" + state}}) {
    EXPECT_TRUE(hub.ExpectError("/?token=")) << hub.ErrorText();
    const std::string text = hub.ErrorText();
    address = text.substr(text.find("http://"));
    address = address.substr(0, address.find_first_of("\n "));
  }
  Process hub;
  std::string address;
};

}  // namespace web_support

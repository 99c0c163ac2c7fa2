#include "tests/task_manager/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <stdexcept>

#include "vm_protocol/core/lower_case.h"

namespace vxml_test {
namespace {

/// Reads a request with its body. False if the client went away.
bool Read(int fd, HttpServer::Request& request) {
  std::string text;
  char buffer[4096];
  std::size_t head = std::string::npos;
  std::size_t length = 0;
  while (head == std::string::npos || text.size() < head + 4 + length) {
    const ssize_t n = ::recv(fd, buffer, sizeof buffer, 0);
    if (n <= 0) return false;
    text.append(buffer, static_cast<std::size_t>(n));
    head = text.find("\r\n\r\n");
    if (head == std::string::npos) continue;
    request.headers = vm::LowerCase(text.substr(0, head));
    const std::size_t at = request.headers.find("content-length:");
    length = at == std::string::npos ? 0 : std::stoul(request.headers.substr(at + 15));
  }
  const std::size_t blank = text.find(' ');
  request.method = text.substr(0, blank);
  request.target = text.substr(blank + 1, text.find(' ', blank + 1) - blank - 1);
  request.body = text.substr(head + 4);
  return true;
}

}  // namespace

HttpServer::HttpServer(Handler handler) : handler_(std::move(handler)) {
  listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(listener_, 16) != 0 ||
      ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("the test's server has no port");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { Serve(); });
}

HttpServer::~HttpServer() {
  ::shutdown(listener_, SHUT_RDWR);
  thread_.join();
  ::close(listener_);
  for (const int fd : kept_) ::close(fd);
}

std::string HttpServer::Url(const std::string& path) const {
  return "http://127.0.0.1:" + std::to_string(port_) + path;
}

std::vector<HttpServer::Request> HttpServer::requests() const {
  const std::scoped_lock lock(mutex_);
  return requests_;
}

void HttpServer::Serve() {
  for (int fd; (fd = ::accept(listener_, nullptr, nullptr)) >= 0;) {
    Request request;
    if (!Read(fd, request)) {
      ::close(fd);
      continue;
    }
    {
      const std::scoped_lock lock(mutex_);
      requests_.push_back(request);
    }
    const std::string answer = handler_(request);
    if (answer.empty()) {
      kept_.push_back(fd);
      continue;
    }
    std::string_view left = answer;
    while (!left.empty()) {
      const ssize_t n = ::send(fd, left.data(), left.size(), MSG_NOSIGNAL);
      if (n <= 0) break;
      left.remove_prefix(static_cast<std::size_t>(n));
    }
    ::close(fd);
  }
}

std::string Answer(const std::string& body, const std::string& headers, const std::string& status) {
  return "HTTP/1.1 " + status + "\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\nConnection: close\r\n" + headers + "\r\n" + body;
}

}  // namespace vxml_test

#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vxml_test {

/// A small HTTP/1.1 server on a free port of the loopback, answering as the test says. One request
/// per connection; written on sockets so that the test compiles fast. Owns one thread, which calls
/// the handler and is joined at the end.
class HttpServer {
 public:
  struct Request {
    std::string method;
    std::string target;
    std::string headers;  ///< in lower case
    std::string body;
  };
  /// The whole answer, status line included; empty = never answer (the connection is kept open).
  using Handler = std::function<std::string(const Request& request)>;

  explicit HttpServer(Handler handler);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::string Url(const std::string& path) const;
  std::vector<Request> requests() const;

 private:
  void Serve();
  Handler handler_;
  int listener_ = -1;
  int port_ = 0;
  mutable std::mutex mutex_;
  std::vector<Request> requests_;  // guarded by mutex_
  std::vector<int> kept_;          // the thread's
  std::thread thread_;
};

/// "HTTP/1.1 200 OK" with a body and further header lines.
std::string Answer(const std::string& body, const std::string& headers = "",
                   const std::string& status = "200 OK");

}  // namespace vxml_test

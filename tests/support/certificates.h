#pragma once

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

namespace support {

/// Makes, with the openssl program, an authority ("ca") in a folder, and certificates signed by it.
/// Files NAME.pem and NAME.key. Throws std::runtime_error if openssl refuses.
class Certificates {
 public:
  explicit Certificates(std::string folder, const std::string& authority = "ca")
      : folder_(std::move(folder)), authority_(authority) {
    Run("req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj '/CN=" +
        authority + "' -keyout " + Key(authority) + " -out " + Certificate(authority));
  }
  /// Good for 127.0.0.1 and localhost.
  void Sign(const std::string& name) const {
    const std::string request = folder_ + "/" + name + ".csr", extensions = folder_ + "/" + name;
    std::ofstream(extensions) << "subjectAltName=IP:127.0.0.1,DNS:localhost\n";
    Run("req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj '/CN=" + name +
        "' -keyout " + Key(name) + " -out " + request);
    Run("x509 -req -days 2 -in " + request + " -CA " + Certificate(authority_) + " -CAkey " +
        Key(authority_) + " -CAcreateserial -extfile " + extensions + " -out " + Certificate(name));
  }
  std::string Certificate(const std::string& name) const { return folder_ + "/" + name + ".pem"; }
  std::string Key(const std::string& name) const { return folder_ + "/" + name + ".key"; }

 private:
  static void Run(const std::string& arguments) {
    if (std::system(("openssl " + arguments + " 2>/dev/null").c_str()) != 0)
      throw std::runtime_error("openssl " + arguments);
  }
  std::string folder_, authority_;
};

}  // namespace support

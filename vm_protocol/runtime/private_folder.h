#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <string>

namespace vm {

/// A folder under /tmp that only this user can enter, for one pipe or socket that another process
/// opens by its path. Owns the folder and that file: both are removed by Remove or the destructor.
/// The file itself is created by the caller or the other process.
/// Thread: none of its own; one instance, one thread.
class PrivateFolder {
 public:
  PrivateFolder() = default;
  ~PrivateFolder() { Remove(); }
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  /// Creates /tmp/galatea-PURPOSE-XXXXXX; file() is then the path of `name` in it. Returns false,
  /// and owns nothing, if the system refuses. REQUIRES: no folder is owned.
  bool Make(const std::string& purpose, const std::string& name) {
    std::string folder = "/tmp/galatea-" + purpose + "-XXXXXX";
    if (mkdtemp(folder.data()) == nullptr) return false;
    folder_ = folder;
    file_ = folder_ + "/" + name;
    return true;
  }
  /// Does nothing if no folder is owned.
  void Remove() {
    if (folder_.empty()) return;
    unlink(file_.c_str());
    rmdir(folder_.c_str());
    folder_.clear();
    file_.clear();
  }
  /// Empty if no folder is owned.
  const std::string& file() const { return file_; }

 private:
  std::string folder_, file_;
};

}  // namespace vm

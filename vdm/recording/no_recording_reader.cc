// In place of recording_reader.cc where the recogniser is not built.

#include "vdm/recording/recording_reader.h"

namespace vdm {

vm::Result<std::unique_ptr<RecordingReader>> RecordingReader::Open() {
  return vm::Fail(vm::Errc::kUnavailable, "this program was built without the recogniser");
}

}  // namespace vdm

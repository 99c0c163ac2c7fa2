#pragma once

#include <js/GCVector.h>
#include <js/Promise.h>
#include <jsapi.h>

namespace vxml::script {

/// What promises of a context wait to run, in order.
class Jobs : public JS::JobQueue {
 public:
  explicit Jobs(JSContext* js) : jobs_(js, JS::StackGCVector<JSObject*>(js)) {}

  JSObject* getIncumbentGlobal(JSContext* js) override { return JS::CurrentGlobalOrNull(js); }
  bool enqueuePromiseJob(JSContext*, JS::HandleObject, JS::HandleObject job, JS::HandleObject,
                         JS::HandleObject) override {
    return jobs_.append(job);
  }
  /// Runs jobs, also those that come meanwhile, until none is left or one is stopped; what is left
  /// then is dropped. A job that throws has told its promise.
  void runJobs(JSContext* js) override {
    for (std::size_t next = 0; next < jobs_.length(); ++next) {
      const JS::RootedObject job(js, jobs_[next]);
      const JSAutoRealm realm(js, job);
      JS::RootedValue result(js);
      const JS::RootedValue function(js, JS::ObjectValue(*job));
      const bool done =
          JS::Call(js, JS::UndefinedHandleValue, function, JS::HandleValueArray::empty(), &result);
      if (!done && !JS_IsExceptionPending(js)) break;
      JS_ClearPendingException(js);
    }
    Drop();
  }
  void Drop() { jobs_.clear(); }
  bool empty() const override { return jobs_.empty(); }

 protected:
  /// Only debuggers save queues.
  js::UniquePtr<SavedJobQueue> saveJobQueue(JSContext*) override { return nullptr; }

 private:
  JS::PersistentRooted<JS::StackGCVector<JSObject*>> jobs_;
};

}  // namespace vxml::script

// A stop that the caller asks for, told from what goes wrong in the work.
#pragma once

#include <exception>
#include <functional>

namespace waretwin {

// A caller stops work by an exception of any kind out of a hook. Work whose own errors are caught and kept as its result asks its hooks
// through ask(), and calls pass_on() before it takes an error for its own.
class CallersStop {
 public:
  void ask(const std::function<void()>& hook) {
    try {
      hook();
    } catch (...) {
      thrown_ = std::current_exception();
      throw;
    }
  }
  void pass_on() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  std::exception_ptr thrown_;
};

}  // namespace waretwin

// "height < 1.6": what a candidate must be like.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace waretwin {

class Condition {
 public:
  // NAME OP VALUE with OP one of < <= > >= == !=; words can only be equal or not. Throws Error for anything else.
  static Condition parse(const std::string& text);

  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  bool is_order() const { return op_ != "==" && op_ != "!="; }
  // Nothing of the name (a measure that has no value) fulfils no condition.
  bool holds(const std::optional<std::string>& value) const;
  bool holds(const std::optional<double>& value) const;

 private:
  std::string text_, name_, op_, value_;
  std::optional<double> number_;
};

// The whole text as a finite number; nothing for anything else.
std::optional<double> as_number(const std::string& text);
// In the shortest form that reads back to the same bits.
std::string number_text(double value);

}  // namespace waretwin

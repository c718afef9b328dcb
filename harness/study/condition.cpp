#include "harness/study/condition.h"

#include <array>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace waretwin {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

bool compare(double a, const std::string& op, double b) {
  if (op == "<") return a < b;
  if (op == "<=") return a <= b;
  if (op == ">") return a > b;
  if (op == ">=") return a >= b;
  return op == "==" ? a == b : a != b;
}

}  // namespace

std::optional<double> as_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [last, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || last != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, status] = [&] {
    // Whole-number keys take no exponent.
    char* const last = buffer.data() + buffer.size();
    const bool plain = value == 0.0 || (std::abs(value) >= 1e-6 && std::abs(value) < 1e15);
    return plain ? std::to_chars(buffer.data(), last, value, std::chars_format::fixed) : std::to_chars(buffer.data(), last, value);
  }();
  return status == std::errc() ? std::string(buffer.data(), end) : std::to_string(value);
}

Condition Condition::parse(const std::string& text) {
  const auto refuse = [&]() -> Condition {
    throw Error("'" + text + "': expected NAME OP VALUE with OP one of <, <=, >, >=, ==, !=, e.g. height < 1.6");
  };
  const std::size_t at = text.find_first_of("<>=!");
  if (at == std::string::npos) return refuse();
  const std::size_t length = at + 1 < text.size() && text[at + 1] == '=' ? 2 : 1;
  Condition condition;
  condition.text_ = trimmed(text);
  condition.name_ = trimmed(text.substr(0, at));
  condition.op_ = text.substr(at, length);
  condition.value_ = trimmed(text.substr(at + length));
  condition.number_ = as_number(condition.value_);
  const bool equality = condition.op_ == "==" || condition.op_ == "!=";
  if (condition.name_.empty() || condition.value_.empty() || condition.op_ == "=" || condition.op_ == "!" ||
      condition.value_.find_first_of("<>=!") != std::string::npos || (!condition.number_ && !equality))
    return refuse();
  return condition;
}

bool Condition::holds(const std::optional<double>& value) const { return value && number_ && compare(*value, op_, *number_); }

bool Condition::holds(const std::optional<std::string>& value) const {
  if (!value) return false;
  const std::optional<double> number = as_number(*value);
  if (number && number_) return holds(number);
  return (op_ == "==" && *value == value_) || (op_ == "!=" && *value != value_);
}

}  // namespace waretwin

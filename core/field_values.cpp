#include "core/field_values.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <type_traits>

#include "core/error.h"

namespace waretwin {

namespace {

using Fail = std::function<void(const std::string&)>;

std::string number_text(double value) {
  WARETWIN_CHECK(std::isfinite(value), "configuration numbers are finite");
  char text[40];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return {text, end.ptr};
}

// Numbers as YAML writes them in decimal; a leading '+' is allowed, hexadecimal and underscores are not.
template <class T>
std::optional<T> parse_number(const YamlNode& node) {
  if (node.kind != YamlNode::Kind::scalar || node.quoted) return std::nullopt;
  const char* begin = node.text.data();
  const char* const end = begin + node.text.size();
  if (begin != end && *begin == '+') {
    ++begin;
    if (begin != end && *begin == '-') return std::nullopt;
  }
  T value{};
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

std::optional<bool> parse_bool(const YamlNode& node) {
  static const std::set<std::string> kTrue = {"true", "True", "TRUE", "yes", "Yes", "YES", "on", "On", "ON"};
  static const std::set<std::string> kFalse = {"false", "False", "FALSE", "no", "No", "NO", "off", "Off", "OFF"};
  if (node.kind != YamlNode::Kind::scalar || node.quoted) return std::nullopt;
  if (kTrue.count(node.text)) return true;
  if (kFalse.count(node.text)) return false;
  return std::nullopt;
}

// long double holds every 64-bit integer, so that the comparison with the rule's bounds is exact.
template <class T>
bool in_range(T value, const FieldRule& rule) {
  const auto v = static_cast<long double>(value);
  return v >= static_cast<long double>(rule.min) && v <= static_cast<long double>(rule.max);
}

bool is_choice(const std::string& text, const FieldRule& rule) {
  if (rule.choices.empty()) return true;
  for (const std::string& choice : rule.choices) {
    if (choice == text) return true;
  }
  return false;
}

std::string describe_node(const YamlNode& node) {
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "has no value";
    case YamlNode::Kind::scalar:
      return "is " + quoted_for_message(node.text) + (node.quoted ? " in quotes" : "");
    case YamlNode::Kind::sequence:
      return "is a list of " + std::to_string(node.values.size());
    case YamlNode::Kind::map:
      return "is a group of keys";
  }
  return "";
}

std::string range_text(const FieldRule& rule) {
  const bool low = std::isfinite(rule.min);
  const bool high = std::isfinite(rule.max);
  if (low && high) return " from " + number_text(rule.min) + " to " + number_text(rule.max);
  if (low) return " of at least " + number_text(rule.min);
  if (high) return " of at most " + number_text(rule.max);
  return "";
}

std::string choices_text(const FieldRule& rule) {
  std::string text = "one of ";
  for (std::size_t i = 0; i < rule.choices.size(); ++i) text += (i ? ", " : "") + rule.choices[i];
  return text;
}

template <class T>
constexpr bool is_number_v = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

// One value from one node; nothing where type, range or choice do not fit.
template <class T>
std::optional<T> parse_value(const YamlNode& node, const FieldRule& rule) {
  if constexpr (std::is_same_v<T, bool>) {
    return parse_bool(node);
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (node.kind != YamlNode::Kind::scalar || !is_choice(node.text, rule)) return std::nullopt;
    return node.text;
  } else {
    const std::optional<T> value = parse_number<T>(node);
    if (!value || !in_range(*value, rule)) return std::nullopt;
    return value;
  }
}

template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};

}  // namespace

void assign_field(FieldRef field, const YamlNode& node, const FieldRule& rule, const Fail& fail) {
  const auto refuse = [&](const std::string& found) {
    fail(found + "; expected " + expected_value(field, rule));
    throw InternalError("the failure of a configuration field did not throw");
  };
  std::visit(
      [&](auto* target) {
        using T = std::remove_pointer_t<decltype(target)>;
        if constexpr (is_vector<T>::value) {
          if (node.kind != YamlNode::Kind::sequence) refuse(describe_node(node));
          if (rule.length && node.values.size() != rule.length) refuse(describe_node(node));
          T values;
          for (const YamlNode::Entry& entry : node.values) {
            const auto value = parse_value<typename T::value_type>(*entry.value, rule);
            if (!value) refuse("holds a value that " + describe_node(*entry.value));
            values.push_back(*value);
          }
          *target = std::move(values);
        } else if constexpr (std::is_same_v<T, std::optional<double>>) {
          const auto value = parse_value<double>(node, rule);
          if (!value && node.kind != YamlNode::Kind::null) refuse(describe_node(node));
          *target = value;
        } else {
          const auto value = parse_value<T>(node, rule);
          if (!value) refuse(describe_node(node));
          *target = *value;
        }
      },
      field);
}

std::string expected_value(FieldRef field, const FieldRule& rule) {
  return std::visit(
      [&](auto* target) -> std::string {
        using T = std::remove_pointer_t<decltype(target)>;
        const std::string count = rule.length ? std::to_string(rule.length) + " " : "";
        if constexpr (std::is_same_v<T, bool>) {
          return "true or false";
        } else if constexpr (std::is_same_v<T, std::string>) {
          return rule.choices.empty() ? "text" : choices_text(rule);
        } else if constexpr (std::is_same_v<T, double>) {
          return "a number" + range_text(rule);
        } else if constexpr (std::is_same_v<T, std::optional<double>>) {
          return "a number" + range_text(rule) + " or null";
        } else if constexpr (is_number_v<T>) {
          FieldRule bounded = rule;
          if (std::is_unsigned_v<T> && bounded.min < 0) bounded.min = 0;
          return "a whole number" + range_text(bounded);
        } else if constexpr (std::is_same_v<T, std::vector<double>>) {
          const std::string range = range_text(rule);
          return "a list of " + count + "numbers" + (range.empty() ? "" : ", each" + range);
        } else {
          return "a list of " + count + "words" + (rule.choices.empty() ? "" : ", each " + choices_text(rule));
        }
      },
      field);
}

std::string field_as_yaml(FieldRef field) {
  return std::visit(
      [](auto* source) -> std::string {
        using T = std::remove_pointer_t<decltype(source)>;
        if constexpr (std::is_same_v<T, bool>) {
          return *source ? "true" : "false";
        } else if constexpr (std::is_same_v<T, std::string>) {
          return text_as_yaml(*source);
        } else if constexpr (std::is_same_v<T, double>) {
          return number_text(*source);
        } else if constexpr (std::is_same_v<T, std::optional<double>>) {
          return *source ? number_text(**source) : "null";
        } else if constexpr (is_number_v<T>) {
          return std::to_string(*source);
        } else {
          std::string text;
          for (const auto& value : *source) {
            if (!text.empty()) text += ", ";
            if constexpr (std::is_same_v<T, std::vector<double>>) {
              text += number_text(value);
            } else {
              text += text_as_yaml(value);
            }
          }
          return "[" + text + "]";
        }
      },
      field);
}

std::string text_as_yaml(const std::string& text) {
  static const std::set<std::string> kWords = {"null", "Null", "NULL", "true", "True", "TRUE", "false", "False", "FALSE",
                                               "yes",  "Yes",  "YES",  "no",   "No",   "NO",   "on",    "On",    "ON",
                                               "off",  "Off",  "OFF",  "y",    "Y",    "n",    "N"};
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/'; };
  const auto is_plain = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == ' '; };
  bool plain = !text.empty() && is_letter(text.front()) && text.back() != ' ' && !kWords.count(text);
  for (const char c : text) plain = plain && is_plain(c);
  if (plain) return text;
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", code);
      out += escape;
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string quoted_for_message(const std::string& text) {
  constexpr std::size_t kLongest = 100;
  std::string line = text.substr(0, kLongest);
  for (char& c : line) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return "'" + line + (text.size() > kLongest ? "..." : "") + "'";
}

std::string joined_key(const std::string& prefix, const std::string& key) { return prefix.empty() ? key : prefix + "." + key; }

}  // namespace waretwin

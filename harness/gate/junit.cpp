#include "harness/gate/junit.h"

#include <cstdio>

namespace waretwin {

namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\n':
        out += "&#10;";  // a plain one becomes a space in an attribute
        break;
      default:
        out += static_cast<unsigned char>(c) < 0x20 && c != '\t' ? '?' : c;
    }
  }
  return out;
}

std::string attribute(const char* name, const std::string& value) { return std::string(" ") + name + "=\"" + escaped(value) + "\""; }

std::string problem(const char* element, const std::string& text) {
  return std::string("      <") + element + attribute("message", text.substr(0, text.find('\n'))) + ">" + escaped(text) + "</" + element +
         ">\n";
}

std::string seconds_of(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", seconds);
  return text;
}

}  // namespace

std::string junit_xml(const std::vector<JunitSuite>& suites) {
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const JunitSuite& suite : suites) {
    std::size_t failures = 0, errors = 0;
    double seconds = 0.0;
    for (const JunitCase& one : suite.cases) {
      errors += one.error.empty() ? 0 : 1;
      failures += one.error.empty() && !one.failure.empty() ? 1 : 0;
      seconds += one.seconds.value_or(0.0);
    }
    xml += "  <testsuite" + attribute("name", suite.name) + attribute("tests", std::to_string(suite.cases.size())) +
           attribute("failures", std::to_string(failures)) + attribute("errors", std::to_string(errors)) +
           attribute("time", seconds_of(seconds)) + ">\n";
    for (const JunitCase& one : suite.cases) {
      xml += "    <testcase" + attribute("classname", one.class_name) + attribute("name", one.name);
      if (one.seconds) xml += attribute("time", seconds_of(*one.seconds));
      if (one.failure.empty() && one.error.empty()) {
        xml += "/>\n";
        continue;
      }
      xml += ">\n" + (one.error.empty() ? problem("failure", one.failure) : problem("error", one.error)) + "    </testcase>\n";
    }
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace waretwin

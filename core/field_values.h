// The values of configuration fields: from YAML nodes into the struct, and back to YAML text. Shared by the readers and writers
// behind core/config.h.
#pragma once

#include <functional>
#include <string>

#include "core/fields.h"
#include "core/yaml_tree.h"

namespace waretwin {

// Writes the node's value into the field. Where type, range, length or choice do not fit it calls fail("is 'x'; expected ..."), which
// must throw, and leaves the field as it was.
void assign_field(FieldRef field, const YamlNode& node, const FieldRule& rule, const std::function<void(const std::string&)>& fail);

// "a number from 0 to 1", "one of gaussian, none", "a list of 3 numbers": what the field takes.
std::string expected_value(FieldRef field, const FieldRule& rule);

// The field's value as YAML on one line; doubles in the shortest form that reads back to the same bits.
std::string field_as_yaml(FieldRef field);

// Text as a YAML scalar, quoted where it would not read back as that text.
std::string text_as_yaml(const std::string& text);

// Text from a file, cut and stripped of line ends so that it fits into a one-line message.
std::string quoted_for_message(const std::string& text);

// "a.b.c"; an empty prefix gives the key alone.
std::string joined_key(const std::string& prefix, const std::string& key);

}  // namespace waretwin

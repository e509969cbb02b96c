// XmlPrinter: elements as the text of an XML file.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include <tinyxml2.h>

namespace freeplay {

/// Prints elements, two blanks for each level.
class XmlPrinter : public tinyxml2::XMLPrinter {
 public:
  using Attributes = std::initializer_list<std::pair<const char*, std::string>>;

  void open(const char* name, const Attributes& attributes) {
    OpenElement(name);
    for (const auto& [key, value] : attributes) PushAttribute(key, value.c_str());
  }
  void element(const char* name, const Attributes& attributes) {
    open(name, attributes);
    CloseElement();
  }

 private:
  void PrintSpace(int depth) override {
    for (int level = 0; level < depth; ++level) Write("  ", 2);
  }
};

}  // namespace freeplay

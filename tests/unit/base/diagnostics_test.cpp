#include "base/diagnostics.h"

#include <gtest/gtest.h>

namespace freeplay {
namespace {

Diagnostics with_source(const std::string& text, bool strict = false) {
  Diagnostics diagnostics(strict);
  diagnostics.add_source("m.yaml", text);
  return diagnostics;
}

TEST(Diagnostics, PrintTheFormatOfTheManual) {
  Diagnostics diagnostics;
  std::string text(8, '\n');
  text += "  crank: {mass: 0.2 kg, intertia: 1e-4}\n";
  diagnostics.add_source("four-bar.yaml", text);
  diagnostics.error({"four-bar.yaml", 9, 25}, 8, "unknown-key", "unknown key 'intertia' in 'bodies.crank'", "inertia");
  EXPECT_EQ(diagnostics.format(20),
            "four-bar.yaml:9:25: error: unknown key 'intertia' in 'bodies.crank' [unknown-key]\n"
            "    9 |   crank: {mass: 0.2 kg, intertia: 1e-4}\n"
            "      |                         ^~~~~~~~\n"
            "      = did you mean 'inertia'?\n");
}

TEST(Diagnostics, PrintHintsAndNotesAfterTheSource) {
  Diagnostics diagnostics = with_source("mass: 1\n");
  diagnostics.add(
      {Severity::warning, "unused", "not used", {"m.yaml", 1, 1}, 4, "", "remove it", {"in instance 'leg2'"}});
  EXPECT_EQ(diagnostics.format(20),
            "m.yaml:1:1: warning: not used [unused]\n"
            "    1 | mass: 1\n"
            "      | ^~~~\n"
            "      = remove it\n"
            "      = in instance 'leg2'\n");
  EXPECT_FALSE(diagnostics.has_errors());
}

TEST(Diagnostics, AreSortedByFileLineAndColumn) {
  Diagnostics diagnostics;
  diagnostics.add_source("b.yaml", "x\ny\n");
  diagnostics.add_source("a.yaml", "x\n");
  diagnostics.error({"a.yaml", 1, 1}, 1, "i", "fourth");
  diagnostics.error({"b.yaml", 2, 1}, 1, "i", "third");
  diagnostics.error({"b.yaml", 1, 9}, 1, "i", "second");
  diagnostics.error({"b.yaml", 1, 2}, 1, "i", "first");
  std::string order;
  for (const Diagnostic& d : diagnostics.sorted()) order += d.message + " ";
  EXPECT_EQ(order, "first second third fourth ");
}

TEST(Diagnostics, ReportTheSameThingOnce) {
  Diagnostics diagnostics = with_source("x\n");
  diagnostics.error({"m.yaml", 1, 1}, 1, "i", "same");
  diagnostics.error({"m.yaml", 1, 1}, 1, "i", "same");
  diagnostics.error({"m.yaml", 1, 1}, 1, "j", "same");
  EXPECT_EQ(diagnostics.sorted().size(), 2u);
}

TEST(Diagnostics, StopAtTheLimitAndSayHowManyAreLeft) {
  Diagnostics diagnostics;
  for (int i = 1; i <= 5; ++i) diagnostics.error({"m.yaml", i, 1}, 1, "i", "bad");
  EXPECT_EQ(diagnostics.format(3),
            "m.yaml:1:1: error: bad [i]\nm.yaml:2:1: error: bad [i]\nm.yaml:3:1: error: bad [i]\n"
            "and 2 more errors; --max-errors 0 shows all\n");
  EXPECT_EQ(diagnostics.format(0).find("more"), std::string::npos);
}

TEST(Diagnostics, PutTheCaretBelowWideCharacters) {
  // Each of the two signs and the emoji take two columns of a terminal, the accent none.
  Diagnostics diagnostics = with_source("\u9023\u6746: {e\u0301: \U0001F600, mas: 1}\n");
  diagnostics.error({"m.yaml", 1, 13}, 3, "i", "bad");
  diagnostics.error({"m.yaml", 1, 1}, 2, "i", "bad");
  EXPECT_EQ(diagnostics.format(0),
            "m.yaml:1:1: error: bad [i]\n"
            "    1 | \u9023\u6746: {e\u0301: \U0001F600, mas: 1}\n"
            "      | ^~~~\n"
            "m.yaml:1:13: error: bad [i]\n"
            "    1 | \u9023\u6746: {e\u0301: \U0001F600, mas: 1}\n"
            "      |               ^~~\n");
}

TEST(Diagnostics, EndTheReadingAfterTooManyErrors) {
  Diagnostics diagnostics;
  const auto report = [&](int line) { diagnostics.error({"m.yaml", line, 1}, 1, "i", "bad"); };
  for (int i = 1; i < Diagnostics::most_messages; ++i) report(i);
  try {
    report(Diagnostics::most_messages);
    FAIL() << "nothing is thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.category(), Error::Category::input);
    EXPECT_EQ(error.id(), "too-large");
    EXPECT_EQ(error.location().line, Diagnostics::most_messages);
  }
  report(1);  // whoever adds the last word need not be careful
}

TEST(Diagnostics, EndTheReadingWhenTheSameErrorComesTooOften) {
  Diagnostics diagnostics;
  const auto report = [&] { diagnostics.error({"m.yaml", 1, 1}, 1, "i", "bad"); };
  for (int i = 1; i < Diagnostics::most_errors; ++i) report();
  EXPECT_THROW(report(), Error);
  EXPECT_EQ(diagnostics.sorted().size(), 1u);
}

TEST(Diagnostics, CountTheWarningsThatAreTooMany) {
  Diagnostics diagnostics;
  for (int i = 1; i <= Diagnostics::most_messages + 7; ++i) diagnostics.warning({"m.yaml", i, 1}, 1, "i", "odd");
  const auto messages = diagnostics.sorted();
  EXPECT_EQ(messages.size(), Diagnostics::most_messages + 1u);
  EXPECT_EQ(messages.back().message, "7 more warnings");
}

TEST(Diagnostics, TurnWarningsIntoErrorsWhenStrict) {
  Diagnostics diagnostics(true);
  diagnostics.warning({"m.yaml", 1, 1}, 1, "unused", "not used");
  EXPECT_TRUE(diagnostics.has_errors());
  EXPECT_EQ(diagnostics.format(0), "m.yaml:1:1: error: not used [unused]\n");
}

TEST(Diagnostics, NeverPrintControlCharacters) {
  Diagnostics diagnostics = with_source("\ta\x1b[31m\u00b5 bad\r\n");
  diagnostics.error({"m\x1b.yaml", 0, 0}, 1, "i", "name 'a\x1b-\n'", "x\x07");
  diagnostics.error({"m.yaml", 1, 9}, 3, "i", "b");
  EXPECT_EQ(diagnostics.format(0),
            "m.yaml:1:9: error: b [i]\n"
            "    1 |  a?[31m\u00b5 bad\n"
            "      |         ^~~\n"
            "m?.yaml: error: name 'a?-?' [i]\n"
            "      = did you mean 'x?'?\n");
}

TEST(Diagnostics, ShowALongLineAroundTheCaret) {
  Diagnostics diagnostics = with_source(std::string(5000, 'a') + "bad" + std::string(5000, 'c') + "\n");
  diagnostics.error({"m.yaml", 1, 5001}, 3, "i", "here");
  const std::string out = diagnostics.format(0);
  EXPECT_LT(out.size(), 500u);
  const std::size_t source = out.find("    1 | "), caret = out.find("      | ");
  EXPECT_EQ(out.find("bad", source) - source, out.find("^~~\n") - caret);
}

TEST(Diagnostics, PointPastTheEndOfALine) {
  Diagnostics diagnostics = with_source("mass:\n");
  diagnostics.error({"m.yaml", 1, 40}, 9, "i", "b");
  EXPECT_EQ(diagnostics.format(0), "m.yaml:1:40: error: b [i]\n    1 | mass:\n      |      ^\n");
}

}  // namespace
}  // namespace freeplay

// One document on a terminal and on a page.
#include "document/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace softland {
namespace {

using internal::table_html;
using internal::table_text;
using internal::words_html;
using ::testing::HasSubstr;
using ::testing::Not;

ReportTable sample_table() {
  ReportTable table{.head = {"Device", "t_i", "v_max", {"Ended", "words"}}, .rows = {}};
  table.rows.push_back({"<slow>", "25.3\u00a0µs", {"∞", "own"}, "by itself"});
  table.rows.push_back({{"one of them", "part"}, {"it does not close & stays open", "missing", 2}, "late"});
  return table;
}

TEST(ReportTable, OfATerminalAlignsNumbersToTheRightAndWordsToTheLeft) {
  EXPECT_EQ(table_text(sample_table()),
            "Device             t_i  v_max  Ended\n"
            "<slow>         25.3\u00a0µs      ∞  by itself\n"
            "  one of them  it does not close & stays open  late\n");
}

TEST(ReportTable, OfATerminalPutsBelowWhatDoesNotFitBeside) {
  EXPECT_EQ(table_text(sample_table(), 22),
            "Device             t_i\n"
            "<slow>         25.3\u00a0µs\n"
            "  one of them  it does not close & stays open\n"
            "\n"
            "Device         v_max  Ended\n"
            "<slow>             ∞  by itself\n"
            "  one of them  late\n")
      << "words in the last column may go beyond the screen";
  EXPECT_EQ(table_text({.head = {"alone"}, .rows = {{"1"}}}), "alone\n1\n");
  EXPECT_EQ(table_text({}), "\n");
}

TEST(ReportTable, BearsRowsBeyondItsHeadsAndNamesThatActOnATerminal) {
  const ReportTable table{.head = {"a", "b"}, .rows = {{"1", "2", "and 3"}, {"\x1b[31m\n", "4"}}};
  EXPECT_EQ(table_text(table),
            "a                 b\n"
            "1                 2  and 3\n"
            "\\u001b[31m\\u000a  4\n");
  EXPECT_THAT(table_html(table), HasSubstr("<td>and 3</td>"));
}

TEST(ReportTable, OfAPageEscapesSetsIndicesAndNamesItsClasses) {
  const std::string page = table_html(sample_table());
  EXPECT_THAT(page, HasSubstr("<th scope=\"col\">v<sub>max</sub></th><th scope=\"col\" class=\"words\">Ended</th>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\">&lt;slow&gt;</th><td>25.3\u00a0µs</td><td class=\"own\">∞</td>"
                              "<td class=\"words\">by itself</td>"));
  EXPECT_THAT(page, HasSubstr("<th scope=\"row\" class=\"part\">one of them</th><td class=\"missing\" colspan=\"2\">it does not "
                              "close &amp; stays open</td><td class=\"words\">late</td>"));
}

TEST(WordsHtml, SetsTheIndicesOfSymbolsAlone) {
  EXPECT_EQ(words_html("t_i, v_max (of B_H) and t_p."), "t<sub>i</sub>, v<sub>max</sub> (of B<sub>H</sub>) and t<sub>p</sub>.");
  for (const char* other : {"driver.t_i", "t_i/x", "t_iv", "at_i", "t_", "_i", "max_slew", ""})
    EXPECT_EQ(words_html(other), other);
  EXPECT_EQ(words_html("a < b & 'c'"), "a &lt; b &amp; &#39;c&#39;");
}

Document sample_document() {
  return {.title = "A <switch>",
          .origin = "test",
          .headline = "It lands",
          .headline_rest = ", softly.",
          .doubt = "Not sure.",
          .keys = {{.name = "t_i", .value = "25 µs", .change = "sooner", .before = "30 µs", .style = "better"}},
          .sections = {{.id = "one",
                        .heading = "First & only",
                        .parts = {SubHeading{"Of devices"}, sample_table(), Paragraph{.text = "A note.", .is_note = true},
                                  ReportList{{"a  command"}}, drawing_of("<svg></svg>"), Paragraph{}}},
                       {.id = "none", .heading = "Nothing", .parts = {Paragraph{}, drawing_of("")}},
                       {.id = "more", .heading = "More", .parts = {Paragraph{"Of a page."}}, .shown = ShownIn::page}},
          .warnings = {"so & so"}};
}

TEST(Document, OnATerminalIsSentencesTablesAndWarnings) {
  EXPECT_EQ(terminal_text(sample_document()), "It lands, softly.\n\nNot sure.\n\nOf devices:\n" + table_text(sample_table()) +
                                                  "\nA note.\n\n  a  command\n\nwarning: so & so\n");
  EXPECT_EQ(terminal_text({}), "");
}

TEST(Document, OnAPageHasItsSectionsButThoseWithNothingToShow) {
  const std::string page = page_html(sample_document());
  EXPECT_THAT(page,
              HasSubstr("<section id=\"one\"><h2>First &amp; only</h2>\n<h3>Of devices</h3>\n" + table_html(sample_table()) +
                        "<p class=\"below\">A note.</p>\n<ul>\n<li>a  command</li>\n</ul>\n<svg></svg></section>"));
  EXPECT_THAT(page, HasSubstr("<p>Of a page.</p>"));
  EXPECT_THAT(page, Not(HasSubstr("id=\"none\"")));
  EXPECT_THAT(page, HasSubstr("<li>so &amp; so</li>"));
  EXPECT_THAT(page,
              HasSubstr("<dt>t<sub>i</sub></dt><dd><span class=\"before\">30 µs <span aria-label=\"becomes\">→</span></span> "
                        "<span class=\"after\">25 µs</span> <span class=\"change better\">sooner</span>"));
  EXPECT_THAT(page, HasSubstr("<h1>It lands<span class=\"rest\">, softly.</span></h1>"));
  EXPECT_THAT(page, HasSubstr("<p class=\"doubt\">Not sure.</p>"));
}

}  // namespace
}  // namespace softland

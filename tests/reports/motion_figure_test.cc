// The animated switch of a page, with a script and without.
#include "reports/motion_figure.h"

#include <gmock/gmock.h>

#include <string>

#include "browser.h"
#include "reports/closing_document.h"
#include "reports/closing_record.h"
#include "sample_result.h"

namespace softland {
namespace {

using internal::motion_figure;
using nlohmann::json;
using test::in_frame;
using test::PageInBrowser;
using test::said;
using test::visit;
using ::testing::HasSubstr;
using ::testing::Not;

ClosingRecord closing_of(const char* scene) {
  const PreparedScene prepared = prepare(SceneFile::load(std::string(SOFTLAND_SOURCE_DIR) + "/scenes/" + scene));
  return record_of(prepared, simulate(prepared, false), "softland test");
}

const ClosingRecord& bouncing() {
  static const ClosingRecord record = closing_of("mem-gold.toml");
  return record;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(MotionFigure, ShowsInstantsWithoutAScript) {
  const std::string figure = motion_figure(bouncing());
  for (const char* words : {"at the start, 0\u00a0s", "first touch, 34.3\u00a0µs", "highest rebound, ",
                            "closed at the end, 600\u00a0µs", "at the contact, enlarged", "electrode main"})
    EXPECT_THAT(figure, HasSubstr(words));
}

TEST(MotionFigure, NamesEachOfSeveralContactsAndDrawsWhatIsOnTheFarSide) {
  const std::string figure = motion_figure(closing_of("new/two-contacts.toml"));
  for (const char* name : {">left<", ">right<", ">stop<"}) EXPECT_THAT(figure, HasSubstr(name));
  EXPECT_EQ(count_of(figure, "data-contact"), 3U);
  EXPECT_THAT(motion_figure(closing_of("two-electrodes.toml")), HasSubstr("electrode upper, gap"));
}

TEST(MotionFigure, DrawsAPlateOnSprings) {
  const std::string figure = motion_figure(closing_of("new/plate.toml"));
  EXPECT_EQ(count_of(figure, "class=\"anchor\""), 2U);
}

TEST(MotionFigure, IsNotThereWhereTheMotionIsNotKnownOrDamaged) {
  EXPECT_EQ(motion_figure(read_closing(test::sample_optimize_result(100))), "");
  const json whole = json_of(bouncing());
  const auto figure_with = [&](const char* key, const json& value) {
    json damaged = whole;
    damaged["curves"]["best"]["motion"][key] = value;
    return motion_figure(read_closing(damaged));
  };
  EXPECT_NE(motion_figure(read_closing(whole)), "");
  for (const char* key : {"time_s", "amplitudes_m", "x_m", "rest_m", "shapes"}) {
    for (const json& value : {json(), json::array(), json::array({1e300, nullptr, 3}), json::array({{1e-6}}), json("much")})
      EXPECT_EQ(figure_with(key, value), "") << key << value;
  }
}

TEST(MotionFigure, LeavesThePageBelowAMegabyte) { EXPECT_LT(page_html(closing_document(bouncing())).size(), 1'000'000U); }

// Functions for scripts: the shown time [s], the gap in the drawing at the contact, and the gap in the chart [m].
constexpr const char* readers =
    "const wait = (time) => new Promise((done) => setTimeout(done, time));"
    "const figure = page.getElementById('figure-motion'), slider = figure.querySelector('input'), play = "
    "figure.querySelector('[data-play]');"
    "const data = JSON.parse(figure.querySelector('.motion-data').textContent), run = data.runs[0];"
    "const {tables} = JSON.parse(page.getElementById('data').textContent);"
    "const unpack = ({unit, steps}) => { let sum = 0; return steps.map((step) => (sum += step) * unit); };"
    "const [times, gaps] = ['time_s', 'tip_gap_m'].map((key) => unpack(tables.best[key]));"
    "const clock = () => 1e-6 * parseFloat(figure.querySelector('.clock').textContent);"
    "const shape = () => figure.querySelector('.moving .best .beam').getAttribute('d');"
    "const set = (value) => { slider.value = value; slider.dispatchEvent(new Event('input')); };"
    "const drawn = () => { const y = shape().slice(1).split('L')[run.places[0]].split(' ')[1]; return data.contacts[0].gap + "
    "(data.bottom - y) / data.perMetre; };"
    "const chart = () => { const at = clock(); let i = 1; while (i < times.length - 1 && times[i] < at) ++i; const share = (at - "
    "times[i - 1]) / (times[i] - times[i - 1] || 1); return gaps[i - 1] + share * (gaps[i] - gaps[i - 1]); };";

std::string seen(const std::string& program, const std::string& script) {
  return said(in_frame(program, page_html(closing_document(bouncing())), 1280, readers + script));
}

TEST_F(PageInBrowser, MovesTheSwitchInSilence_browser) {
  const test::Visit page = visit(program, page_html(closing_document(closing_of("new/two-contacts.toml"))));
  EXPECT_EQ(page.console, "");
  EXPECT_NE(page.dom.find("open, 1.00"), std::string::npos);
}

TEST_F(PageInBrowser, PlaysWhenAskedAndPauses_browser) {
  EXPECT_EQ(seen(program,
                 // In virtual time a browser draws few frames.
                 "const own = frame.contentWindow; own.requestAnimationFrame = (draw) => setTimeout(() => "
                 "draw(own.performance.now()), 16);"
                 "await wait(400); if (clock() !== 0) say('it begins by itself');"
                 "const rest = shape(); play.click(); await wait(600); play.click(); const paused = clock(), held = shape();"
                 "if (!(paused > 0) || held === rest) say('it does not play: ' + paused);"
                 "await wait(300); if (clock() !== paused || shape() !== held) say('it does not pause');"
                 "play.click(); await wait(400); if (!(clock() > paused)) say('it does not go on');"),
            "end;");
}

TEST_F(PageInBrowser, DrawsTheGapOfTheChartAtTheTimeOfTheSlider_browser) {
  EXPECT_EQ(seen(program,
                 "const whole = times[times.length - 1]; for (let value = 0; value <= 1000; value += 7) { set(value);"
                 "if (Math.abs(clock() - whole * value / 1000) > 1e-9) say('at ' + clock());"
                 "if (!(Math.abs(drawn() - chart()) <= 1e-3 * data.contacts[0].gap)) say(drawn() + ' is not ' + chart()); }"),
            "end;");
}

TEST_F(PageInBrowser, TiesTheSliderToTheCursorAndTheViewOfTheCharts_browser) {
  EXPECT_EQ(seen(program,
                 "set(100); const read = page.querySelector('#figure-gap .u-value').textContent;"
                 "if (!/[0-9]/.test(read)) say('the charts have no cursor');"
                 "const over = page.querySelector('#figure-gap .u-over'); const before = clock();"
                 "for (let i = 0; i < 5; ++i) over.dispatchEvent(new frame.contentWindow.KeyboardEvent('keydown', {key: "
                 "'ArrowRight'})); await wait(50); if (!(clock() > before)) say('the cursor moves nothing');"
                 "page.querySelector('[data-view=landing]').click(); await wait(50); set(1000);"
                 "if (!(clock() < 0.5 * times[times.length - 1])) say('the slider has another view');"),
            "end;");
}

TEST_F(PageInBrowser, TellsWhenTheContactIsClosed_browser) {
  EXPECT_EQ(seen(program,
                 "const state = () => figure.querySelector('.reads .best dd').textContent;"
                 "set(0); if (!state().startsWith('open, 2.00')) say(state()); set(1000); if (!state().startsWith('closed')) "
                 "say(state()); if (!figure.querySelector('[data-contact].closed')) say('the contact is not marked');"),
            "end;");
}

TEST_F(PageInBrowser, TakesSomeSecondsForOneReboundAtTheSlowestSpeed_browser) {
  const Rebound& highest = *std::ranges::max_element(bouncing().best.curve.rebounds, {}, &Rebound::height);
  const std::string speed =
      seen(program, "const speeds = figure.querySelectorAll('option'); say(speeds[speeds.length - 1].value);");
  EXPECT_NEAR((highest.end - highest.begin) / std::stod(speed), 4, 1e-6);
}

}  // namespace
}  // namespace softland

//! A plot of time against FLIP with the Pareto front, as SVG.

use framewright_lab::choosing;
use framewright_lab::results::{Group, Outcome, Results};
use framewright_viewer::escape_xml as escaped;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Width of a group's diagram with its margins, and of the list beside it, in pixels.
const WIDTHS: [f64; 2] = [560.0, 340.0];
/// Height of a group's diagram with its margins.
const HEIGHT: f64 = 360.0;
/// Left, top, right and bottom margin.
const MARGINS: [f64; 4] = [64.0, 36.0, 16.0, 48.0];
/// The number of the front's points that are listed.
const LISTED: usize = 14;

const STYLE: &str = "svg{background:#fff;color:#1c1c1c;font:12px system-ui,sans-serif}\
text{fill:currentColor}.axis{stroke:currentColor;opacity:.6}.grid{stroke:currentColor;opacity:.12}\
circle{fill:#8a8a8a;fill-opacity:.7}.front circle{fill:#0a5fb4;fill-opacity:1}polyline{fill:none;stroke:#0a5fb4;stroke-width:1.5}\
@media (prefers-color-scheme:dark){svg{background:#16181b;color:#e8e8e8}.front circle{fill:#7ab8ff}polyline{stroke:#7ab8ff}}";

/// A row with both figures.
struct Point {
    figures: [f64; 2],
    name: String,
}

/// A diagram for each scene, size and way of stereo. Points of the front are joined, numbered and listed.
pub(super) fn front(results: &Results) -> String {
    let mut groups: BTreeMap<Group, Vec<Point>> = BTreeMap::new();
    for row in &results.rows {
        let Outcome::Measured(measured) = &row.outcome else { continue };
        let (Some(errors), Some(time), true) = (&measured.errors, measured.cost.gpu_milliseconds, measured.is_finite())
        else {
            continue;
        };
        let figures = [time.median, errors.flip.mean];
        groups.entry(row.group()).or_default().push(Point { figures, name: results.shown(&row.settings) });
    }
    let (width, height) = (WIDTHS[0] + WIDTHS[1], HEIGHT * groups.len().max(1) as f64);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\">\n\
         <style>{STYLE}</style>\n"
    );
    if groups.is_empty() {
        svg += "<text x=\"24\" y=\"40\">no row has a time and errors</text>\n";
    }
    for (at, (group, points)) in groups.iter().enumerate() {
        let _ = writeln!(svg, "<g transform=\"translate(0 {})\">", HEIGHT * at as f64);
        diagram(&mut svg, &group.name(), points);
        svg += "</g>\n";
    }
    svg + "</svg>\n"
}

fn diagram(svg: &mut String, title: &str, points: &[Point]) {
    let [left, top, right, bottom] = MARGINS;
    let inner = [WIDTHS[0] - left - right, HEIGHT - top - bottom];
    let ends = [0, 1].map(|axis| end(points.iter().map(|point| point.figures[axis])));
    let place = |figures: [f64; 2]| {
        [left + figures[0] / ends[0].0 * inner[0], top + inner[1] - figures[1] / ends[1].0 * inner[1]]
    };
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"22\" font-weight=\"bold\">{}</text>", escaped(title));
    for axis in [0, 1] {
        let (most, step) = ends[axis];
        for tick in 0..=(most / step).round() as u32 {
            let value = f64::from(tick) * step;
            let mut at = [0.0; 2];
            at[axis] = value;
            let [x, y] = place(at);
            let shown = (value * 1e9).round() / 1e9;
            let _ = match axis {
                0 => writeln!(
                    svg,
                    "<path class=\"grid\" d=\"M{x:.1} {top}V{y:.1}\"/><text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{shown}</text>",
                    y + 18.0
                ),
                _ => writeln!(
                    svg,
                    "<path class=\"grid\" d=\"M{left} {y:.1}H{:.1}\"/><text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{shown}</text>",
                    left + inner[0],
                    left - 8.0,
                    y + 4.0
                ),
            };
        }
    }
    let (middle, foot) = (left + inner[0] / 2.0, top + inner[1]);
    let _ = writeln!(svg, "<path class=\"axis\" fill=\"none\" d=\"M{left} {top}V{foot}H{}\"/>", left + inner[0]);
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">GPU time, ms</text>", foot + 38.0);
    let _ = writeln!(
        svg,
        "<text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">FLIP, mean</text>",
        top + inner[1] / 2.0
    );
    let front = choosing::front(&points.iter().map(|point| point.figures).collect::<Vec<_>>());
    for (at, point) in points.iter().enumerate() {
        if !front.contains(&at) {
            circle(svg, point, place(point.figures));
        }
    }
    let joined: Vec<String> =
        front.iter().map(|at| place(points[*at].figures)).map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let _ = writeln!(svg, "<g class=\"front\"><polyline points=\"{}\"/>", joined.join(" "));
    for (number, at) in (1_u16..).zip(&front) {
        let [x, y] = place(points[*at].figures);
        circle(svg, &points[*at], [x, y]);
        if usize::from(number) <= LISTED {
            let _ = writeln!(svg, "<text x=\"{:.1}\" y=\"{:.1}\">{number}</text>", x + 6.0, y - 5.0);
            let line = top + 20.0 * f64::from(number);
            let shown: String = points[*at].name.chars().take(52).collect();
            let _ = writeln!(svg, "<text x=\"{}\" y=\"{line}\">{number}: {}</text>", WIDTHS[0] + 8.0, escaped(&shown));
        }
    }
    let heading = if front.len() > LISTED { "the front, its first points:" } else { "the front:" };
    let _ = writeln!(svg, "<text x=\"{}\" y=\"{top}\">{heading}</text></g>", WIDTHS[0] + 8.0);
}

fn circle(svg: &mut String, point: &Point, [x, y]: [f64; 2]) {
    let [time, flip] = point.figures;
    let about = format!("{}\n{time:.3} ms, FLIP {flip:.5}", point.name);
    let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"><title>{}</title></circle>", escaped(&about));
}

/// A round number that no figure exceeds, and the step of its ticks.
fn end(figures: impl Iterator<Item = f64>) -> (f64, f64) {
    let most = figures.fold(0.0, f64::max);
    if most <= 0.0 || !most.is_normal() {
        return (1.0, 0.25);
    }
    let power = 10.0_f64.powf((most / 5.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| most <= 5.0 * step);
    let step = step.filter(|step| step.is_normal()).unwrap_or(most / 5.0);
    ((most / step).ceil() * step, step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_ends_at_a_round_number_above_all_figures() {
        assert_eq!(end([0.3, 4.7].into_iter()), (5.0, 1.0));
        assert_eq!(end([7.0].into_iter()), (8.0, 2.0));
        assert_eq!(end(std::iter::empty()), (1.0, 0.25));
        for most in [1e-300, 3e-9, 0.017, 1.0, 10.0, 99.9, 1e300] {
            let (end, step) = end([most].into_iter());
            assert!(end >= most * 0.999_999 && end / step <= 6.0 && step > 0.0, "{most}: {end} {step}");
        }
    }
}

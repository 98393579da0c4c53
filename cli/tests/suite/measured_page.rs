//! The page of a sweep, in a real browser: plot, table and pictures are those of the results.

use crate::testing::Place;
use crate::testing::browser::Browser;
use crate::testing::results::{Row, results, write};

/// Six rows: the third is beaten, the fourth failed, the fifth has pixels that aren't finite, the sixth was too slow in its frames.
fn swept(place: &Place) {
    let row = |msaa: &str, ms: f64, flip: f64| Row::new(&[("msaa", msaa)]).costs(ms, 4 << 20).errors(flip, flip, 0.9);
    let rows = [
        row("1", 1.0, 0.08).pictures("pictures/a b.png", "pictures/r#1.png"),
        row("4", 2.0, 0.03),
        row("2", 3.0, 0.05),
        row("8", 1.0, 0.01).failed("no <b>device</b> has 8"),
        row("16", 1.0, 0.01).not_finite(3),
        row("32", 0.5, 0.01).flicker(0.1, 7),
    ];
    std::fs::create_dir_all(place.path("a/pictures")).expect("a folder");
    for name in ["a b.png", "r#1.png"] {
        image::RgbImage::from_pixel(4, 4, image::Rgb([200, 10, 10]))
            .save(place.path("a/pictures").join(name))
            .expect("written");
    }
    write(place, "a", &results(rows.map(Row::value).into()));
    place.run(&["merge", "a", "-o", "b"]).exits(0);
}

#[test]
fn the_page_of_a_sweep_shows_its_rows_as_plot_table_and_pictures() {
    let Some(mut browser) = Browser::start() else { return };
    let place = Place::new();
    swept(&place);
    browser.open_file(&place.path("b/index.html"), "");
    for dark in [true, false] {
        browser.screen(1400, 900, dark);
        assert_eq!(browser.faint_texts(), Vec::<String>::new(), "dark {dark}");
    }
    // Rows that failed, or have pixels that aren't finite, are in the table alone.
    assert_eq!(browser.count("document.querySelectorAll('circle').length"), 3);
    assert_eq!(browser.count("document.querySelectorAll('tbody tr').length"), 6);
    assert_eq!(browser.count("document.querySelectorAll('circle.front').length"), 2);
    let failed = browser.text("document.querySelector('td.failed').textContent");
    assert_eq!(failed, "no <b>device</b> has 8");
    // The table is sorted by the column that is clicked, numbers by size.
    let first = "[...document.querySelectorAll('tbody tr')].map((line) => line.cells[0].textContent).join()";
    let sort = "document.querySelector('th button').click()";
    browser.ask(sort);
    assert_eq!(browser.text(first), "1,2,4,8,16,32");
    browser.ask(sort);
    assert_eq!(browser.text(first), "32,16,8,4,2,1");
    assert_eq!(browser.text("document.querySelector('th').getAttribute('aria-sort')"), "descending");
    let by = |name: &str| {
        format!("[...document.querySelectorAll('th button')].find((it) => it.textContent === {name:?}).click()")
    };
    browser.ask(&by("FLIP"));
    // Equal figures keep their order; what is missing comes last.
    assert!(browser.text(first).ends_with(",4,2,1,8"), "{}", browser.text(first));
    // Both axes can be any figures: less memory isn't less error.
    let label = "document.querySelector('#plot svg').getAttribute('aria-label')";
    assert_eq!(browser.text(label), "GPU ms against FLIP");
    browser.ask("at('across').value = AXES.findIndex((axis) => axis.name === 'SSIM'), at('across').dispatchEvent(new Event('change'))");
    browser.ask("at('up').value = AXES.findIndex((axis) => axis.name === 'GPU ms'), at('up').dispatchEvent(new Event('change'))");
    assert_eq!(browser.text(label), "SSIM against GPU ms");
    // All are as alike: the fastest alone is on the front.
    assert_eq!(browser.count("document.querySelectorAll('circle.front').length"), 1);
    // The pictures of the row that is picked are shown, and loaded.
    let line = |msaa: &str| {
        format!(
            "[...document.querySelectorAll('tbody tr')].find((line) => line.cells[0].textContent === '{msaa}').click()"
        )
    };
    browser.ask(&line("1"));
    assert_eq!(browser.count("document.querySelectorAll('#pictures img').length"), 2);
    browser
        .until("[...document.querySelectorAll('#pictures img')].every((it) => it.complete && it.naturalWidth === 4)");
    for (msaa, said) in [("16", "3 pixels of the picture; "), ("32", "7 pixels of moving frames; ")] {
        browser.ask(&line(msaa));
        let shown = browser.text("document.getElementById('settings').textContent");
        assert!(shown.contains(said), "{shown}");
    }
    browser.has_no_errors();
}

//! `merge`: results of several folders become one, whatever their order, and nothing is mixed silently; and files of results
//! that are damaged, for all commands.

use crate::testing::Place;
use crate::testing::results::{Numbers, Row, results, write};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// All files in a folder of a place, by their paths.
fn files(place: &Place, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(place.path(folder)).expect("a folder").map(|entry| entry.expect("an entry")) {
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        match entry.path().is_dir() {
            true => found.extend(files(place, &name)),
            false => drop(found.insert(name, std::fs::read(entry.path()).expect("read"))),
        }
    }
    found
}

/// The files of the joined results of some folders, by their paths in it.
fn merged(place: &Place, folders: &[&str], to: &str) -> BTreeMap<String, Vec<u8>> {
    let arguments = [&["merge"], folders, &["-o", to]].concat();
    place.run(&arguments).exits(0);
    files(place, to).into_iter().map(|(name, bytes)| (name[to.len()..].to_owned(), bytes)).collect()
}

/// A row with a picture of its own and a reference that all share.
fn row(place: &Place, folder: &str, msaa: u64, name: &str) -> Value {
    std::fs::create_dir_all(place.path(folder).join("shown")).expect("a folder");
    let picture = format!("shown/{name}.png");
    place.file(format!("{folder}/{picture}"), format!("picture {msaa}"));
    place.file(format!("{folder}/reference.exr"), "the reference");
    let row = Row::new(&[("msaa", &msaa.to_string())]).costs(msaa as f64, 1 << 20).errors(0.5 / msaa as f64, 0.1, 0.9);
    row.pictures(&picture, "reference.exr").value()
}

#[test]
fn joined_results_depend_on_no_order_and_rows_count_once() {
    let mut numbers = Numbers(11);
    for _ in 0..12 {
        let place = Place::new();
        // Rows are dealt to three folders, some to several; pictures of different rows share names.
        let mut parts: [Vec<Value>; 3] = Default::default();
        for msaa in 1..=6 {
            let first = numbers.below(3);
            for (at, part) in parts.iter_mut().enumerate() {
                if at as u64 == first || numbers.below(4) == 0 {
                    let name = part.len().to_string();
                    part.push(row(&place, &format!("part{at}"), msaa, &name));
                }
            }
        }
        for (at, rows) in parts.iter_mut().enumerate() {
            if numbers.below(2) == 0 {
                rows.reverse();
            }
            write(&place, &format!("part{at}"), &results(rows.clone()));
        }
        let all = merged(&place, &["part0", "part1", "part2"], "all");
        let joined: Value = serde_json::from_slice(&all["/results.json"]).expect("JSON");
        let rows = joined["rows"].as_array().expect("rows");
        let values: Vec<u64> =
            rows.iter().map(|row| row["choice"]["msaa"].as_str().expect("it").parse().expect("it")).collect();
        assert_eq!(values, [1, 2, 3, 4, 5, 6]);
        for (row, msaa) in rows.iter().zip(values) {
            let measured = &row["outcome"]["measured"];
            let picture = |name: &str| &all[&format!("/{}", measured[name].as_str().expect("a path"))];
            assert_eq!(picture("picture"), format!("picture {msaa}").as_bytes());
            assert_eq!(picture("reference"), b"the reference");
        }
        // Six pictures, a reference, results, a table, a page and a plot.
        assert_eq!(all.len(), 11, "{:?}", all.keys());
        assert!(merged(&place, &["part2", "part0", "part1"], "other_order") == all);
        assert!(merged(&place, &["part0", "part1"], "two") != BTreeMap::new());
        assert!(merged(&place, &["part2", "two"], "in_steps") == all);
        assert!(merged(&place, &["all"], "again") == all);
        assert!(merged(&place, &["all", "part1", "all", "two"], "twice") == all);
        // Over itself: nothing changes.
        assert!(merged(&place, &["part0", "part1", "part2"], "all") == all);
    }
}

/// The message about two folders, the second with something changed.
fn refused(change: impl FnOnce(&mut Value)) -> String {
    let place = Place::new();
    let row = Row::new(&[("msaa", "4")]).value();
    let mut other = results(vec![row]);
    write(&place, "a", &other);
    change(&mut other);
    write(&place, "b", &other);
    let before = place.names();
    let forwards = place.run(&["merge", "a", "b", "-o", "c"]).exits(1).err;
    place.run(&["merge", "b", "a", "-o", "c"]).exits(1);
    place.run(&["choose", "a", "b", "--max-ms", "9"]).exits(1);
    assert_eq!(place.names(), before);
    forwards
}

#[test]
fn results_of_different_things_are_not_joined() {
    for (field, value) in [
        ("pipeline", json!("other.ron")),
        ("pipeline_digest", json!("fedcba9876543210")),
        ("device", json!("another")),
        ("driver", json!("a driver 2.0")),
        ("frames", json!(17)),
        ("flicker_frames", json!(16)),
        ("framewright", json!("1.2.4")),
        ("shipped_shaders", json!("0000000000000000")),
        ("reference", json!("none")),
        ("baseline", json!({ "msaa": "8", "scale": "1" })),
    ] {
        let said = refused(|results| results["subject"][field] = value);
        assert!(
            said.contains("`a` and `b` hold results of different things") && said.contains(&format!("`{field}` is")),
            "{said}"
        );
    }
    let said = refused(|results| results["rows"][0]["scene_digest"] = json!("changed"));
    assert!(said.contains("the scene `scene.ron` changed between the results in `a` and those in `b`"), "{said}");
    // Other rows of a scene that changed are no better.
    let said = refused(|results| {
        results["rows"][0]["scene_digest"] = json!("changed");
        results["rows"][0]["choice"]["msaa"] = json!("8");
    });
    assert!(said.contains("the scene `scene.ron` changed"), "{said}");
}

#[test]
fn one_row_with_different_figures_is_refused() {
    for (field, path, value) in [
        ("cost", "/outcome/measured/cost/moved_bytes", json!(6)),
        ("errors", "/outcome/measured/errors/rmse", json!(0.5)),
        ("passes", "/outcome/measured/passes/0/name", json!("other")),
        (
            "reference_errors",
            "/outcome/measured/reference_errors",
            Row::new(&[]).value()["outcome"]["measured"]["errors"].clone(),
        ),
        ("settings", "/settings/msaa", json!("8")),
        ("outcome", "/outcome", json!({ "failed": "out of memory" })),
    ] {
        let said = refused(|results| *results["rows"][0].pointer_mut(path).expect(path) = value);
        let row = format!("the same row with different figures ({field}): msaa=4 of scene.ron at 64x64");
        assert!(said.contains(&row), "{said}");
    }
}

#[test]
fn pictures_that_leave_the_folder_are_refused() {
    for path in ["/etc/hostname.png", "../outside.png", "shown/../../outside.png", "a.txt", "C:\\a.png", ""] {
        let place = Place::new();
        place.file("outside.png", "secret");
        write(&place, "a", &results(vec![Row::new(&[("msaa", "4")]).pictures(path, "reference.png").value()]));
        let outcome = place.run(&["merge", "a", "-o", "b"]).exits(1);
        outcome.mentions("row 1 (msaa=4 of scene.ron at 64x64): `picture` is `");
        assert_eq!(place.names(), ["a", "outside.png"]);
    }
    let place = Place::new();
    let named = results(vec![Row::new(&[("msaa", "4")]).pictures("picture.png", "picture.png").value()]);
    write(&place, "a", &named);
    place.run(&["merge", "a", "-o", "b"]).exits(1).mentions("the picture `a/picture.png` can't be read");
    #[cfg(unix)]
    {
        place.file("outside.png", "secret");
        std::os::unix::fs::symlink("../outside.png", place.path("a/picture.png")).expect("a link");
        place.run(&["merge", "a", "-o", "b"]).exits(1).mentions("lies outside of `a`: a link leads there");
    }
    assert!(!place.path("b").exists());
}

#[test]
fn no_results_are_lost() {
    let place = Place::new();
    for (folder, msaa) in [("a", 1), ("b", 2)] {
        let own = row(&place, folder, msaa, "own");
        write(&place, folder, &results(vec![own]));
    }
    let before = [files(&place, "a"), files(&place, "b")];
    place.run(&["merge", "a", "-o", "b"]).exits(2).mentions("`b` holds other results, which would be lost");
    place
        .run(&["merge", "a", "b", "-o", "b"])
        .exits(2)
        .mentions("is a file of results that is read, which would be lost");
    assert_eq!([files(&place, "a"), files(&place, "b")], before);
    place
        .run(&["merge", "missing", "-o", "c"])
        .exits(1)
        .mentions("the file of results `missing/results.json` can't be read");
    place.run(&["merge", "-o", "c"]).exits(2);
    assert!(!place.path("c").exists());
    // What can't be finished has no results, or those that it had.
    std::fs::create_dir(place.path("c")).expect("a folder");
    place.file("c/pictures", "no folder");
    place.run(&["merge", "a", "b", "-o", "c"]).exits(3).mentions("`c/pictures` can't be written");
    assert_eq!(files(&place, "c").into_keys().collect::<Vec<_>>(), ["c/pictures"]);
    std::fs::remove_file(place.path("c/pictures")).expect("removed");
    merged(&place, &["a"], "c");
    let before = files(&place, "c");
    std::fs::remove_file(place.path("b/reference.exr")).expect("removed");
    place.run(&["merge", "a", "b", "-o", "c"]).exits(1).mentions("the picture `b/reference.exr` can't be read");
    assert_eq!(files(&place, "c"), before);
}

#[test]
fn damaged_results_are_refused_with_their_place() {
    let place = Place::new();
    let whole = serde_json::to_string_pretty(&results(vec![Row::new(&[("msaa", "4")]).value()])).expect("JSON");
    let too_many = results(vec![Row::new(&[("msaa", "4")]).not_finite(9000).value()]).to_string();
    let said = |text: &str| {
        std::fs::create_dir_all(place.path("a")).expect("a folder");
        place.file("a/results.json", text);
        let said = place.run(&["choose", "a", "--max-ms", "9"]).exits(1).err;
        assert!(said.starts_with("error: `a/results.json` ") && !place.path("c").exists(), "{said}");
        place.run(&["merge", "a", "-o", "c"]).exits(1);
        said
    };
    for (text, expected) in [
        (String::new(), "is damaged at line 1, column 0: EOF while parsing a value"),
        (whole[..whole.len() / 2].to_owned(), "is damaged at line "),
        (whole.replacen("\"rows\"", "\"lines\"", 1), "column 9: unknown field `lines`"),
        (whole.replacen("\"median\": 1.0", "\"median\": NaN", 1), "expected value"),
        (whole.replacen("\"median\": 1.0", "\"median\": null", 1), "invalid type: null, expected f64"),
        (whole.replacen("\"median\": 1.0", "\"median\": 1e999", 1), "number out of range"),
        (whole.clone() + "x", "trailing characters"),
        (
            whole.replacen("\"format_version\": 1", "\"format_version\": 2", 1),
            "is of format version 2, and this program reads version 1",
        ),
        ("{\"format_version\": 7, \"new\": []}".to_owned(), "is of format version 7"),
        (whole.replacen("\"median\": 1.0", "\"median\": -1.0", 1), "can't have the median -1 between 0.75 and 1.25"),
        (whole.replacen("\"median\": 1.0", "\"median\": 2.0", 1), "can't have the median 2 between"),
        (whole.replacen("\"worst\": 1.0", "\"worst\": 1.5", 1), "`errors.flip.worst` can't be 1.5"),
        (whole.replacen("\"ssim\": 1.0", "\"ssim\": 1.25", 1), "`errors.ssim` can't be 1.25"),
        (whole.replacen("\"rmse\": 0.0", "\"rmse\": 5.0", 1), "`errors.rmse` can't be 5"),
        (whole.replacen("\"psnr\": 30.0", "\"psnr\": -3000.0", 1), "`errors.psnr` can't be -3000"),
        (whole.replacen("\"frames\": 16", "\"frames\": 0", 1), "`frames` can't be 0"),
        (whole.replacen("64", "0", 1), "the size 0x64 is none"),
        (too_many, "can't be 9000 of 8192 pixels"),
    ] {
        assert!(text != whole, "{expected}");
        let said = said(&text);
        assert!(said.contains(expected) && (said.contains("\nhelp: ")), "`{expected}` is not in {said}");
    }
    place.file("a/results.json", [0xff, b'{']);
    place.run(&["merge", "a", "-o", "c"]).exits(1).mentions("is not text: byte 0 is not UTF-8");
}

#[test]
fn the_table_and_the_page_hold_whatever_texts_results_hold() {
    let place = Place::new();
    let evil = "</script><script>alert(1)</script>, \"x\"\r\n=1+1 & <!--";
    let value = results(vec![
        Row::new(&[("msaa", evil)]).scene("a, b.ron").value(),
        Row::new(&[("msaa", "4")]).scene("a, b.ron").failed(evil).value(),
    ]);
    write(&place, "a", &value);
    place.run(&["merge", "a", "-o", "b"]).exits(0);
    let text = |name: &str| std::fs::read_to_string(place.path(name)).expect("a text");
    let table = text("b/results.csv");
    assert!(table.starts_with("scene,width,height,stereo,set.msaa,gpu_ms,gpu_ms_low,gpu_ms_high,"), "{table}");
    let quoted = format!("\"{}\"", evil.replace('"', "\"\""));
    assert!(table.contains(&format!("\r\n\"a, b.ron\",64,64,off,{quoted},1,0.75,1.25,1,")), "{table}");
    assert!(table.contains("\r\n\"a, b.ron\",64,64,off,4,,,,") && table.contains(&format!(",{quoted}\r\n")), "{table}");
    let page = text("b/index.html");
    assert_eq!(page.matches("</script>").count(), 2, "the data's and the script's own");
    let addresses = page.matches("http:").count() + page.matches("https:").count()
        - page.matches("\"http://www.w3.org/2000/svg\"").count();
    assert_eq!(addresses, 0, "the page asks for nothing");
    let (_, data) = page.split_once("id=\"data\">").expect("the data");
    let data: Value = serde_json::from_str(data.split_once("</script>").expect("its end").0).expect("JSON");
    assert_eq!(data["results"], serde_json::from_str::<Value>(&text("b/results.json")).expect("JSON"));
    let plot = text("b/front.svg");
    assert!(plot.contains("&lt;/script&gt;") && !plot.contains("<script"), "{plot}");
}

/// A spreadsheet would run what such a cell says.
#[test]
fn no_cell_of_the_table_begins_a_formula() {
    let place = Place::new();
    let texts = ["=1+1", "+1+1", "-1+1", "@SUM(A1)", "\t=1", "-0.5", "+2", "1=1"];
    let rows = texts.map(|text| Row::new(&[("look", text)]).scene("=scene").failed(text).value());
    write(&place, "a", &results(rows.into()));
    place.run(&["merge", "a", "-o", "b"]).exits(0);
    let mut table = csv::Reader::from_path(place.path("b/results.csv")).expect("a table");
    let lines: Vec<csv::StringRecord> = table.records().map(|line| line.expect("a line")).collect();
    let mut shown: Vec<&str> = lines.iter().map(|line| &line[4]).collect();
    shown.sort_unstable();
    let mut expected = ["'=1+1", "'+1+1", "'-1+1", "'@SUM(A1)", "'\t=1", "-0.5", "+2", "1=1"];
    expected.sort_unstable();
    assert_eq!(shown, expected);
    for line in &lines {
        assert_eq!((&line[0], &line[4]), ("'=scene", line.iter().next_back().expect("an error")));
    }
}

#[cfg(unix)]
#[test]
fn results_for_which_there_is_no_room_leave_nothing() {
    let place = Place::new();
    let own = row(&place, "a", 1, "own");
    write(&place, "a", &results(vec![own]));
    merged(&place, &["a"], "b");
    let sizes = files(&place, "b").into_iter().map(|(name, bytes)| (name, bytes.len())).collect::<BTreeMap<_, _>>();
    // In blocks of 512 bytes or of 1024: the page doesn't fit, and all other files do.
    assert!(sizes["b/index.html"] > 8192 && sizes.iter().all(|(name, size)| *size < 4096 || name == "b/index.html"));
    let mut shell = std::process::Command::new("sh");
    let limited = "ulimit -f 8; exec \"$0\" merge a -o c";
    shell.args(["-c", limited, env!("CARGO_BIN_EXE_framewright")]).current_dir(place.path(""));
    let outcome = crate::testing::outcome(&mut shell).exits(3);
    outcome.mentions("`c/index.html` can't be written: File too large");
    assert!(files(&place, "c").keys().all(|name| name.starts_with("c/pictures/")), "{:?}", files(&place, "c").keys());
}

/// Each column of the table holds the figure that it is named for.
#[test]
fn every_column_of_the_table_is_its_own_figure() {
    let place = Place::new();
    let (row, columns) = numbered(Row::new(&[("msaa", "4")]).flicker(0.5, 0).pictures("p.png", "r.png").value());
    for picture in ["p.png", "r.png"] {
        std::fs::create_dir_all(place.path("a")).expect("a folder");
        place.file(format!("a/{picture}"), picture);
    }
    write(&place, "a", &results(vec![row]));
    place.run(&["merge", "a", "-o", "b"]).exits(0);
    let mut table = csv::Reader::from_path(place.path("b/results.csv")).expect("a table");
    let head = table.headers().expect("a head").clone();
    let line = table.records().next().expect("a line").expect("a line");
    let shown: BTreeMap<&str, &str> = head.iter().zip(&line).collect();
    for (column, figure) in columns {
        assert_eq!(shown[column].parse::<f64>().ok(), Some(figure), "{column}");
    }
}

/// A row whose figures all differ, and the columns in which they stand.
fn numbered(mut row: Value) -> (Value, Vec<(&'static str, f64)>) {
    row["outcome"]["measured"]["reference_errors"] = row["outcome"]["measured"]["errors"].clone();
    let at = [
        ("gpu_ms", "cost/gpu_milliseconds/median", 5.0),
        ("gpu_ms_low", "cost/gpu_milliseconds/low", 4.0),
        ("gpu_ms_high", "cost/gpu_milliseconds/high", 6.0),
        ("gpu_ratio", "cost/gpu_ratio/median", 1.5),
        ("gpu_ratio_low", "cost/gpu_ratio/low", 1.25),
        ("gpu_ratio_high", "cost/gpu_ratio/high", 1.75),
        ("recording_ms", "cost/recording_milliseconds/median", 0.5),
        ("recording_ms_low", "cost/recording_milliseconds/low", 0.375),
        ("recording_ms_high", "cost/recording_milliseconds/high", 0.625),
        ("transient_bytes", "cost/transient_bytes", 1000.0),
        ("moved_bytes", "cost/moved_bytes", 2000.0),
        ("fragment_invocations", "cost/fragment_invocations", 3000.0),
        ("flip", "errors/flip/mean", 0.015),
        ("flip_95", "errors/flip/percentile_95", 0.025),
        ("flip_worst", "errors/flip/worst", 0.035),
        ("rmse", "errors/rmse", 0.045),
        ("max_error", "errors/max_error", 0.055),
        ("relative_mse", "errors/relative_mse", 0.065),
        ("psnr", "errors/psnr", 27.0),
        ("ssim", "errors/ssim", 0.925),
        ("reference_flip", "reference_errors/flip/mean", 0.0125),
        ("reference_rmse", "reference_errors/rmse", 0.0225),
        ("flicker", "flicker/mean", 0.0325),
        ("flicker_95", "flicker/percentile_95", 0.0425),
        ("flicker_worst", "flicker/worst", 0.0525),
    ];
    for (_, path, figure) in at {
        let path = format!("/outcome/measured/{path}");
        let whole = path.ends_with("_bytes") || path.ends_with("invocations");
        *row.pointer_mut(&path).expect("a figure") = if whole { json!(figure as u64) } else { json!(figure) };
    }
    (row, at.map(|(column, _, figure)| (column, figure)).into())
}

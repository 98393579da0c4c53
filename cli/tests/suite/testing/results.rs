//! Results of sweeps, made by hand or by chance.

use super::Place;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Numbers by chance, the same from the same seed (Knuth's MMIX generator).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// A number below another.
    pub(crate) fn below(&mut self, most: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % most
    }
}

/// A row that is measured without any error, unless it says otherwise.
#[derive(Debug, Clone)]
pub(crate) struct Row(Value);

impl Row {
    /// A row of some settings, of which those that begin with `@` are its surroundings.
    pub(crate) fn new(choice: &[(&str, &str)]) -> Row {
        let map = |of: &mut dyn Iterator<Item = &(&str, &str)>| {
            Value::Object(of.map(|(name, value)| ((*name).to_owned(), json!(value))).collect())
        };
        let row = json!({
            "choice": map(&mut choice.iter()),
            "settings": map(&mut choice.iter().filter(|(name, _)| !name.starts_with('@'))),
            "scene": "scene.ron",
            "scene_digest": "scene.ron: a digest",
            "size": [64, 64],
            "stereo": "off",
            "outcome": { "measured": {
                "cost": {
                    "gpu_milliseconds": spread(1.0),
                    "gpu_ratio": spread(1.0),
                    "recording_milliseconds": spread(0.125),
                    "transient_bytes": 1 << 20,
                    "moved_bytes": 5 << 20,
                    "fragment_invocations": null,
                },
                "errors": null,
                "reference_errors": null,
                "passes": [{ "name": "opaque", "gpu_milliseconds": spread(0.5) }],
                "picture": null,
                "reference": null,
                "heat_map": null,
                "flicker": null,
                "flicker_map": null,
            } },
        });
        Row(row).errors(0.0, 0.0, 1.0)
    }

    fn measured(mut self, change: impl FnOnce(&mut Value)) -> Row {
        change(&mut self.0["outcome"]["measured"]);
        self
    }

    pub(crate) fn scene(mut self, scene: &str) -> Row {
        self.0["scene"] = json!(scene);
        self.0["scene_digest"] = json!(format!("{scene}: a digest"));
        self
    }

    pub(crate) fn costs(self, milliseconds: f64, transient_bytes: u64) -> Row {
        self.measured(|measured| {
            measured["cost"]["gpu_milliseconds"] = spread(milliseconds);
            measured["cost"]["gpu_ratio"] = spread(milliseconds / 2.0);
            measured["cost"]["transient_bytes"] = json!(transient_bytes);
        })
    }

    /// The time relative to the baseline's, which differs from frame to frame by a part of it.
    pub(crate) fn ratio(self, median: f64, part: f64) -> Row {
        let ratio = json!({ "median": median, "low": median * (1.0 - part), "high": median * (1.0 + part) });
        self.measured(|measured| measured["cost"]["gpu_ratio"] = ratio)
    }

    pub(crate) fn without_times(self) -> Row {
        self.measured(|measured| {
            measured["cost"]["gpu_milliseconds"] = Value::Null;
            measured["cost"]["gpu_ratio"] = Value::Null;
            measured["passes"][0]["gpu_milliseconds"] = Value::Null;
        })
    }

    pub(crate) fn moved(self, bytes: u64) -> Row {
        self.measured(|measured| measured["cost"]["moved_bytes"] = json!(bytes))
    }

    pub(crate) fn errors(self, flip: f64, rmse: f64, ssim: f64) -> Row {
        let flip = json!({
            "exposures": null, "pixels_per_degree": 67.02, "mean": flip, "percentile_95": 1.0, "worst": 1.0,
        });
        let errors = json!({
            "flip": flip, "rmse": rmse, "max_error": 4.0, "relative_mse": 0.5, "psnr": 30.0, "ssim": ssim,
            "non_finite": [0, 0],
        });
        self.measured(|measured| measured["errors"] = errors)
    }

    pub(crate) fn further_errors(self, max_error: f64, relative_mse: f64, psnr: f64) -> Row {
        self.measured(|measured| {
            measured["errors"]["max_error"] = json!(max_error);
            measured["errors"]["relative_mse"] = json!(relative_mse);
            measured["errors"]["psnr"] = json!(psnr);
        })
    }

    /// The reference's own FLIP.
    pub(crate) fn reference_error(self, flip: f64) -> Row {
        self.measured(|measured| {
            measured["reference_errors"] = measured["errors"].clone();
            measured["reference_errors"]["flip"]["mean"] = json!(flip);
        })
    }

    pub(crate) fn flicker(self, mean: f64, non_finite: u32) -> Row {
        let flicker =
            json!({ "frames": 16, "mean": mean, "percentile_95": 1.0, "worst": 1.5, "non_finite": non_finite });
        self.measured(|measured| measured["flicker"] = flicker)
    }

    pub(crate) fn not_finite(self, pixels: u32) -> Row {
        self.measured(|measured| measured["errors"]["non_finite"] = json!([0, pixels]))
    }

    pub(crate) fn without_reference(self) -> Row {
        self.measured(|measured| measured["errors"] = Value::Null)
    }

    pub(crate) fn failed(mut self, error: &str) -> Row {
        self.0["outcome"] = json!({ "failed": error });
        self
    }

    /// Its pictures, as paths within the folder.
    pub(crate) fn pictures(self, picture: &str, reference: &str) -> Row {
        self.measured(|measured| {
            measured["picture"] = json!(picture);
            measured["reference"] = json!(reference);
        })
    }

    pub(crate) fn value(self) -> Value {
        self.0
    }
}

fn spread(median: f64) -> Value {
    json!({ "median": median, "low": median * 0.75, "high": median * 1.25 })
}

/// Results with these rows.
pub(crate) fn results(rows: Vec<Value>) -> Value {
    json!({
        "format_version": 1,
        "subject": {
            "framewright": "1.2.3",
            "shipped_shaders": "89abcdef01234567",
            "pipeline": "no_such_pipeline.ron",
            "pipeline_digest": "0123456789abcdef",
            "device": "a device",
            "driver": "a driver 1.0",
            "frames": 16,
            "flicker_frames": null,
            "reference": "auto",
            "baseline": {
                "msaa": "4", "scale": "1", "@scene": "scene.ron: a digest", "@size": "64x64", "@stereo": "off",
            },
        },
        "rows": rows,
    })
}

/// Writes results to a folder of a place. The answer is their file.
pub(crate) fn write(place: &Place, folder: &str, results: &Value) -> PathBuf {
    std::fs::create_dir_all(place.path(folder)).expect("a folder");
    place.file(format!("{folder}/results.json"), serde_json::to_string_pretty(results).expect("JSON"))
}

//! Questions for pictures that a page asks for when they are looked at, and their answers.

use crate::page::{PictureSize, Thumbnail};
use framewright_graph::frame::CaptureName;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use tokio::sync::oneshot;

/// A question asks for at most this many pictures.
pub(super) const MOST_PICTURES: usize = 64;

/// Pictures that a page asks for, as JSON.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AskedPictures {
    /// The number of the frame that the page shows: see [`LiveState::frame`](super::LiveState::frame).
    pub frame: u64,
    /// The pictures.
    pub pictures: Vec<AskedPicture>,
}

/// A picture that a page asks for.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AskedPicture {
    /// What is shown.
    pub of: CaptureName,
    /// At which size.
    pub size: PictureSize,
}

/// What became of a picture that was asked for.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureAnswer {
    /// It.
    Picture(Box<Thumbnail>),
    /// Why there is none, in words.
    Problem(String),
}

/// A question that waits for its answer.
#[derive(Debug)]
pub struct Question {
    /// What is asked.
    pub asked: AskedPictures,
    answer: oneshot::Sender<String>,
}

/// An answer, as JSON.
#[derive(Serialize)]
struct Answer<'a> {
    frame: u64,
    pictures: &'a [PictureAnswer],
}

impl Question {
    pub(super) fn new(asked: AskedPictures) -> (Question, oneshot::Receiver<String>) {
        let (answer, answered) = oneshot::channel();
        (Question { asked, answer }, answered)
    }

    /// Whether somebody still waits for the answer.
    #[must_use]
    pub fn is_waiting(&self) -> bool {
        !self.answer.is_closed()
    }

    /// What the pictures are of, each once.
    #[must_use]
    pub fn names(&self) -> BTreeSet<CaptureName> {
        self.asked.pictures.iter().map(|picture| picture.of.clone()).collect()
    }

    /// Answers: `picture` makes each picture, or says in words why there is none.
    ///
    /// # Errors
    /// If an answer has no JSON form.
    pub fn answer(self, mut picture: impl FnMut(&AskedPicture) -> Result<Thumbnail, String>) -> serde_json::Result<()> {
        let mut made = |asked: &AskedPicture| match picture(asked) {
            Ok(thumbnail) => PictureAnswer::Picture(Box::new(thumbnail)),
            Err(why) => PictureAnswer::Problem(why),
        };
        let pictures: Vec<PictureAnswer> = self.asked.pictures.iter().map(&mut made).collect();
        let text = serde_json::to_string(&Answer { frame: self.asked.frame, pictures: &pictures })?;
        // Who asked may have left.
        drop(self.answer.send(text));
        Ok(())
    }

    /// Answers all of it with the same words.
    ///
    /// # Errors
    /// If an answer has no JSON form.
    pub fn refuse(self, why: &str) -> serde_json::Result<()> {
        self.answer(|_| Err(why.to_owned()))
    }
}

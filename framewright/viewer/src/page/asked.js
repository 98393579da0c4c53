/** Pictures that the server draws when they are looked at. Questions of one moment go together, one after the other. */
const asking = { waiting: [], known: new Map(), drawn: new Map(), busy: false, frame: null, selected: null };

/** A question asks for at most this many pictures. */
const MOST_ASKED = 32;

/** What the server calls a capture. */
const nameOfCapture = ({ pass, image, mip, layer, stencil }) => ({ pass, image, mip, layer, stencil });

/** The part of an image that a capture shows: captures of the same image are compared by it. */
const partKey = ({ mip, layer, stencil }) => [mip, layer, stencil].join();

const isSameCapture = (one, other) => one.image === other.image && one.pass === other.pass && partKey(one) === partKey(other);

/** Lets go of pictures that were drawn: those of another frame, or of an earlier one of a program that goes on. */
function forgetPictures() {
  asking.known.clear();
  asking.drawn.clear();
}

/** Another selection shows pictures of the newest frame. */
function forgetWithSelection() {
  if (asking.selected !== state.selected) forgetPictures();
  asking.selected = state.selected;
}

const questionKey = (capture, size) => JSON.stringify([nameOfCapture(capture), size]);

/** A picture that was drawn at this size already. */
const drawnPicture = (capture, size) => (capture.data ? capture : asking.frame === live.frame ? asking.drawn.get(questionKey(capture, size)) : undefined);

/**
 * The picture of a capture at a size: `most` texels at its longer side, or of `region` alone. A page without a server has the pictures that
 * it holds. What can't be had is an error with words.
 */
function askFor(capture, size) {
  if (!DATA.live) return capture.data ? Promise.resolve(capture) : Promise.reject(new Error("The page holds no picture of it."));
  if (asking.frame !== live.frame) {
    asking.frame = live.frame;
    forgetPictures();
  }
  const key = questionKey(capture, size);
  if (!asking.known.has(key)) {
    const asked = new Promise((done, fail) => asking.waiting.push({ of: nameOfCapture(capture), size, done, fail, frame: live.frame }));
    // What failed may be asked for again.
    asked.then((picture) => { if (asking.known.get(key) === asked) asking.drawn.set(key, picture); }, () => asking.known.delete(key));
    asking.known.set(key, asked);
    if (!asking.busy) {
      asking.busy = true;
      setTimeout(sendQuestions, 20);
    }
  }
  return asking.known.get(key);
}

async function sendQuestions() {
  while (asking.waiting.length > 0) {
    const [{ frame }] = asking.waiting;
    const asked = asking.waiting.filter((one) => one.frame === frame).slice(0, MOST_ASKED);
    asking.waiting = asking.waiting.filter((one) => !asked.includes(one));
    try {
      const body = JSON.stringify({ frame, pictures: asked.map(({ of, size }) => ({ of, size })) });
      const answer = await fetch("pictures", { method: "POST", headers: { "content-type": "application/json" }, body });
      if (!answer.ok) throw new Error(await answer.text());
      const { pictures } = await answer.json();
      asked.forEach(({ done, fail }, at) => (pictures[at].picture ? done(pictures[at].picture) : fail(new Error(pictures[at].problem))));
    } catch (problem) {
      asked.forEach(({ fail }) => fail(problem instanceof TypeError ? new Error("The server doesn't answer.") : problem));
    }
  }
  asking.busy = false;
}

/** Calls `act` once, as soon as something of an element is in sight. */
function whenSeen(made, act) {
  const observer = new IntersectionObserver((entries) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    act();
  });
  observer.observe(made);
}

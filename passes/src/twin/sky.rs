//! Twin of `shaders/sky.frag`: what the sun adds to the sky. The sky itself is [`crate::scene::Sky::towards`].

/// How tight the glow around the sun and the sun's own disc are.
const GLOW_EXPONENT: f64 = 32.0;
const DISC_EXPONENT: f64 = 2048.0;
/// How bright they are beside a white surface that faces the sun.
const GLOW_SHARE: f64 = 0.15;
const DISC_SHARE: f64 = 4.0;
/// The sun is seen from this height on, as the sine of an angle; at the same height above the horizon it is seen whole.
const LOWEST: f64 = -0.02;

/// The share of the sun's colour that is added towards a direction whose sine of height is `height`, where `sunward` is the
/// cosine of the angle to the sun.
#[must_use]
pub fn sun_share(height: f64, sunward: f64) -> f64 {
    let at = ((height - LOWEST) / (-2.0 * LOWEST)).clamp(0.0, 1.0);
    let above = at * at * (3.0 - 2.0 * at);
    let sunward = sunward.clamp(0.0, 1.0);
    above * (GLOW_SHARE * sunward.powf(GLOW_EXPONENT) + DISC_SHARE * sunward.powf(DISC_EXPONENT))
}

/// The largest of these shares over all directions, where `height` is the sine of the sun's own height: at the sun, or for a
/// sun below the horizon where the sky over it begins to show it.
#[must_use]
pub fn sunward_share(height: f64) -> f64 {
    let (sun, lowest) = (height.clamp(-1.0, 1.0).asin(), LOWEST.asin());
    let sunward = (lowest - sun).max(0.0).cos().max(0.0);
    GLOW_SHARE * sunward.powf(GLOW_EXPONENT) + DISC_SHARE * sunward.powf(DISC_EXPONENT)
}

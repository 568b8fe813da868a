//! Long records: samples far closer than the instrument resolves are averaged, and the stretch around the impact is kept.

use super::record::{Channel, Record};

/// Samples per period of the bandwidth that are kept: their mean damps what the instrument passes by 0.4 % at most.
const PER_PERIOD: f64 = 20.0;
/// Most samples that are kept: 25 ms at 2 MHz.
const MOST: usize = 50_000;
/// Blocks over the length of the contact in which the impact is looked for.
const BLOCKS: f64 = 2.0;
/// Part of the largest change of the signals that counts as the impact: a stop behind it may be larger.
const IMPACT: f64 = 0.3;

/// The record as far as an impact of the length `contact` (s) and the free flights around it need it; `bandwidth` in Hz.
pub(super) fn shortened(record: Record, bandwidth: f64, contact: f64) -> Record {
    let length = record.time[record.time.len() - 1] - record.time[0];
    let per_period = (record.time.len() - 1) as f64 / (length * bandwidth);
    let block = (per_period / PER_PERIOD) as usize;
    let averaged = if block > 1 && record.time.len() > MOST { means(&record, block) } else { record };
    let count = averaged.time.len();
    if count <= MOST {
        return averaged;
    }
    let middle = impact(&averaged, contact).clamp(MOST / 2, count - MOST / 2);
    part(&averaged, middle - MOST / 2..middle + MOST / 2)
}

/// Means over `block` samples each; what is left of the last block goes.
fn means(record: &Record, block: usize) -> Record {
    let mean = |values: &Vec<f64>| -> Vec<f64> {
        values.chunks_exact(block).map(|chunk| chunk.iter().sum::<f64>() / block as f64).collect()
    };
    let channels = record.channels.iter();
    let channels = channels.map(|channel| Channel { values: mean(&channel.values), ..*channel });
    Record { time: mean(&record.time), channels: channels.collect(), ..record.without_samples() }
}

fn part(record: &Record, range: std::ops::Range<usize>) -> Record {
    let channels = record.channels.iter();
    let channels =
        channels.map(|channel| Channel { values: channel.values[range.clone()].to_vec(), ..*channel });
    Record {
        time: record.time[range.clone()].to_vec(),
        channels: channels.collect(),
        ..record.without_samples()
    }
}

/// The sample about which the signals change first by a good part of their largest change: of a displacement the slope, else the value.
fn impact(record: &Record, contact: f64) -> usize {
    let count = record.time.len();
    let interval = (record.time[count - 1] - record.time[0]) / (count - 1) as f64;
    let block = ((contact / (BLOCKS * interval)) as usize).clamp(1, count / 8);
    let blocks = means(record, block);
    let changes = blocks.channels.iter().map(|channel| {
        let values: Vec<f64> = match channel.quantity.ends_with("displacement") {
            true => channel.values.windows(2).map(|pair| pair[1] - pair[0]).collect(),
            false => channel.values.clone(),
        };
        // over the contact and a block more on each side
        let reach = BLOCKS as usize + 2;
        let changes: Vec<f64> =
            (reach..values.len()).map(|k| (values[k] - values[k - reach]).abs()).collect();
        let largest = changes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        changes.iter().position(|change| *change >= IMPACT * largest).unwrap_or(0) + reach / 2
    });
    changes.min().unwrap_or(0) * block
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A second of a velocity that changes at 0.7 s by an impact and at 0.9 s by a harder stop, with noise.
    #[test]
    fn the_impact_of_a_long_record_is_kept_with_its_free_flights() {
        let mut random = fastrand::Rng::with_seed(1);
        let samples = 4_000_000;
        let time: Vec<f64> = (0..samples).map(|k| 0.25e-6 * k as f64).collect();
        let velocity = |t: f64| {
            let after = ((t - 0.7) / 80e-6).clamp(0.0, 1.0);
            if t < 0.9 { -0.46 * after } else { 0.6 }
        };
        let values = time.iter().map(|t| velocity(*t) + 0.01 * (random.f64() - 0.5)).collect();
        let channels = vec![Channel { quantity: "inner_velocity", values }];
        let record =
            Record { file: "long.csv".into(), time, channels, gaps: Vec::new(), integrals: Vec::new() };
        let kept = shortened(record.clone(), 100e3, 100e-6);
        assert!(kept.time.len() <= MOST);
        let (first, last) = (kept.time[0], kept.time[kept.time.len() - 1]);
        assert!(first < 0.695 && last > 0.705 && last < 0.9, "{first} to {last}");
        // the mean of two samples at their mean time
        let at = kept.time.iter().position(|t| *t > 0.69).expect("there");
        let k = (kept.time[at] / 0.25e-6).floor() as usize;
        let mean = 0.5 * (record.channels[0].values[k] + record.channels[0].values[k + 1]);
        assert!((kept.channels[0].values[at] - mean).abs() < 1e-12);
        // a short record stays as it is
        let short = part(&record, 0..MOST);
        assert_eq!(shortened(short.clone(), 100e3, 100e-6), short);
    }
}

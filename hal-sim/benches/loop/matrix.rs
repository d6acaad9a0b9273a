//! What three sines on three encoders make of three errors: the largest of it.

/// A complex number.
pub type Complex = [f64; 2];
/// S at a frequency: what a sine on the encoder of the second index makes of the error of the first.
pub type Matrix = [[Complex; 3]; 3];

/// The largest value, and at which frequency it is.
#[derive(Clone, Copy, Default)]
pub struct Peak {
    pub hz: f64,
    pub size: f64,
}

impl Peak {
    pub fn of(values: impl Iterator<Item = (f64, f64)>) -> Self {
        values
            .map(|(hz, size)| Self { hz, size })
            .max_by(|a, b| a.size.total_cmp(&b.size))
            .unwrap_or_default()
    }
}

/// The largest singular value: the root of the largest eigenvalue of S^H S, by its powers.
pub fn largest_singular_value(matrix: &Matrix) -> f64 {
    // No eigenvector of these three would be at a right angle to that but by chance.
    let mut vector: [Complex; 3] = [[1.0, 0.3], [-0.7, 0.2], [0.4, -0.9]];
    let mut square = 0.0;
    for _ in 0..200 {
        let mut image = [[0.0; 2]; 3];
        for (row, image) in matrix.iter().zip(&mut image) {
            for ([a, b], [c, d]) in row.iter().zip(&vector) {
                image[0] += a * c - b * d;
                image[1] += a * d + b * c;
            }
        }
        let mut back = [[0.0; 2]; 3];
        for (row, [c, d]) in matrix.iter().zip(&image) {
            for ([a, b], back) in row.iter().zip(&mut back) {
                back[0] += a * c + b * d;
                back[1] += a * d - b * c;
            }
        }
        let size = |vector: &[Complex; 3]| {
            (vector.iter().map(|[re, im]| re * re + im * im).sum::<f64>()).sqrt()
        };
        square = size(&back) / size(&vector);
        let length = size(&back);
        vector = back.map(|value| value.map(|part| part / length));
    }
    square.sqrt()
}

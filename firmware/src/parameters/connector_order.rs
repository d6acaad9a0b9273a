//! In which order three connectors belong to the pivots.

/// Which of three connectors belongs to pivot 1, 2 and 3, each to one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ConnectorOrder([u8; 3]);

impl ConnectorOrder {
    /// Connector 1 is pivot 1's, 2 pivot 2's, 3 pivot 3's.
    pub const STRAIGHT: Self = Self([0, 1, 2]);

    /// For connectors counted from 0; `None` if one is named twice, or is none.
    fn new(connectors: [usize; 3]) -> Option<Self> {
        let mut seen = [false; 3];
        for connector in connectors {
            *seen.get_mut(connector)? = true;
        }
        (seen == [true; 3]).then_some(Self(connectors.map(|it| it as u8)))
    }

    /// Of a number whose digits are the connectors of pivot 1, 2 and 3, counted from 1: 231.
    pub fn from_digits(digits: f64) -> Option<Self> {
        let digits = digits as usize;
        Self::new([digits / 100, digits / 10 % 10, digits % 10].map(|it| it.wrapping_sub(1)))
    }

    /// What the connectors have, pivot by pivot.
    #[inline]
    pub fn of_pivots<T: Copy>(self, of_connectors: &[T; 3]) -> [T; 3] {
        self.0.map(|connector| match connector {
            0 => of_connectors[0],
            1 => of_connectors[1],
            _ => of_connectors[2],
        })
    }

    /// Which pivot each connector belongs to.
    pub fn inverse(self) -> Self {
        let mut pivots = [0; 3];
        for (pivot, connector) in (0..).zip(self.0) {
            if let Some(slot) = pivots.get_mut(usize::from(connector)) {
                *slot = pivot;
            }
        }
        Self(pivots)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_order_is_its_digits_and_undone_by_its_inverse() {
        let orders = [123.0, 132.0, 213.0, 231.0, 312.0, 321.0];
        for digits in orders {
            let order = ConnectorOrder::from_digits(digits).expect("an order");
            let [a, b, c] = order.of_pivots(&[1.0, 2.0, 3.0]);
            assert_eq!(100.0 * a + 10.0 * b + c, digits);
            assert_eq!(order.inverse().of_pivots(&[a, b, c]), [1.0, 2.0, 3.0]);
        }
        let taken = (0..=999).filter(|&n| ConnectorOrder::from_digits(f64::from(n)).is_some());
        assert_eq!(taken.count(), orders.len());
    }
}

//! The two ways to position an axis.

/// How an axis is positioned [000:4714-4733].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// With servo lag: the velocity is kv times the lag [000:4735-4776].
    Lag,
    /// With feed pre-control: the velocity of the nominal position, and kv times what lag is left
    /// [000:4929-4975].
    Precontrol,
}

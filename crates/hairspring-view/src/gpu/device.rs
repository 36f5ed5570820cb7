//! The GPU device.

use std::sync::{Arc, Mutex, atomic::AtomicU64};

/// Why there is no picture, in one sentence.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is neither a usable GPU nor a software driver.
    #[error(
        "no GPU is available ({0}); install its Vulkan driver, or Mesa's software driver (on Debian and Ubuntu: \
         mesa-vulkan-drivers libvulkan1)"
    )]
    Missing(String),
    /// The GPU rejected a command, or was lost.
    #[error("the GPU failed ({0}); try a smaller picture or fewer hairs, or draw on the CPU")]
    Failed(String),
}

/// A GPU that is ready for use.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    /// Bytes that were sent to the GPU since they were last counted.
    pub(super) sent: Arc<AtomicU64>,
    /// The first error since the last check.
    trouble: Arc<Mutex<Option<String>>>,
}

/// Maximum size of a binding [bytes], if the device supports more than WebGPU's default: 2²⁴ points of 16
/// bytes.
const BINDING: u64 = 1 << 28;

impl Gpu {
    /// Opens the fastest GPU, for rendering without a window. If there is none, a software driver is used.
    ///
    /// # Errors
    /// Returns [`GpuError::Missing`] if there is neither, or if it does not support WebGPU's default limits.
    pub fn open() -> Result<Self, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
        // Not OpenGL, which another crate of the program may have compiled in: its shaders cannot read the depth
        // textures of the shadows.
        descriptor.backends &= wgpu::Backends::PRIMARY;
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| GpuError::Missing(one_line(&e.to_string())))?;
        let most = adapter.limits();
        let default = wgpu::Limits::default();
        // Raises the limits for more hair if the device supports it. All other limits are WebGPU's defaults.
        let required_limits = wgpu::Limits {
            max_buffer_size: most.max_buffer_size.min(BINDING).max(default.max_buffer_size),
            max_storage_buffer_binding_size: most
                .max_storage_buffer_binding_size
                .min(BINDING)
                .max(default.max_storage_buffer_binding_size),
            ..default
        };
        let descriptor =
            wgpu::DeviceDescriptor { label: Some("hairspring"), required_limits, ..Default::default() };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| GpuError::Missing(one_line(&e.to_string())))?;
        let gpu = Self::from_parts(device, queue);
        // Without a handler, an error on the GPU would end the program.
        let trouble = gpu.trouble.clone();
        gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut first) = trouble.lock() {
                first.get_or_insert(one_line(&error.to_string()));
            }
        }));
        Ok(gpu)
    }

    /// Wraps a device that a window already uses. Errors of the device stay with the handler that is
    /// installed there.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        Self { device, queue, info, sent: Arc::default(), trouble: Arc::default() }
    }

    /// Name of the GPU.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// Whether this is a software driver. The CPU [`Renderer`](crate::Renderer) is then much faster.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Maximum width and height of a picture [pixels]: 8192 by WebGPU's default.
    pub fn most_pixels(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Waits until the GPU has finished all its work.
    ///
    /// # Errors
    /// Returns [`GpuError::Failed`] if the GPU was lost, or if it rejected a command before.
    pub fn wait(&self) -> Result<(), GpuError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|e| GpuError::Failed(one_line(&e.to_string())))?;
        self.check()
    }

    /// Checks for errors on the GPU since the last check.
    ///
    /// # Errors
    /// Returns [`GpuError::Failed`] with the first error.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.trouble.lock().ok().and_then(|mut trouble| trouble.take()) {
            Some(trouble) => Err(GpuError::Failed(trouble)),
            None => Ok(()),
        }
    }

    /// Maximum number of points in a buffer, at 16 bytes each.
    pub(super) fn most_points(&self) -> usize {
        let binding = self.device.limits().max_storage_buffer_binding_size.min(BINDING);
        (binding / 16) as usize
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

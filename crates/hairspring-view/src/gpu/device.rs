//! The graphics card.

use std::sync::{Arc, Mutex, atomic::AtomicU64};

/// Why there is no picture: one sentence.
#[derive(Debug, thiserror::Error)]
pub enum GpuError {
    /// There is no card that can be used, nor a program in its place.
    #[error(
        "no graphics card can be used ({0}); install its Vulkan driver, or Mesa's drawing in software (on Debian and Ubuntu: \
         mesa-vulkan-drivers libvulkan1)"
    )]
    Missing(String),
    /// The card refused something, or was lost while it worked.
    #[error(
        "the graphics card gave up ({0}); a smaller picture or fewer hairs may do, or the picture drawn without it"
    )]
    Failed(String),
}

/// A graphics card that is ready for work.
#[derive(Clone, Debug)]
pub struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    /// Bytes that were handed over to it, since they were last counted.
    pub(super) sent: Arc<AtomicU64>,
    /// The first thing that went wrong since it was last asked.
    trouble: Arc<Mutex<Option<String>>>,
}

/// Bytes that a binding may have where a device lends more than WebGPU's default: 2²⁴ points of 16.
const BINDING: u64 = 1 << 28;

impl Gpu {
    /// The fastest card there is, for pictures that no window shows. Where there is none, a driver that draws in software will do.
    ///
    /// # Errors
    /// [`GpuError::Missing`] if there is neither, or it lacks what WebGPU's default limits ask for.
    pub fn open() -> Result<Self, GpuError> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))
            .map_err(|e| GpuError::Missing(one_line(&e.to_string())))?;
        let most = adapter.limits();
        let default = wgpu::Limits::default();
        // More hair than fits the default, where the card has room; everything else is WebGPU's default.
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
        // Without a handler, what goes wrong on the card would end the program.
        let trouble = gpu.trouble.clone();
        gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut first) = trouble.lock() {
                first.get_or_insert(one_line(&error.to_string()));
            }
        }));
        Ok(gpu)
    }

    /// A card that a window already draws with. Errors of the device stay with whoever handles them there.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let info = device.adapter_info();
        Self { device, queue, info, sent: Arc::default(), trouble: Arc::default() }
    }

    /// What the card calls itself.
    pub fn name(&self) -> &str {
        &self.info.name
    }

    /// Whether it is no card, but a program in its place: then the CPU [`Renderer`](crate::Renderer) is faster by far.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Greatest width and height of a picture [pixels]: 8192 by WebGPU's default.
    pub fn most_pixels(&self) -> u32 {
        self.device.limits().max_texture_dimension_2d
    }

    /// Waits until the card has done all that it was given.
    ///
    /// # Errors
    /// [`GpuError::Failed`] if it was lost, or refused something before.
    pub fn wait(&self) -> Result<(), GpuError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|e| GpuError::Failed(one_line(&e.to_string())))?;
        self.check()
    }

    /// What went wrong on the card since this was last asked, if anything did.
    ///
    /// # Errors
    /// [`GpuError::Failed`] with the first trouble.
    pub fn check(&self) -> Result<(), GpuError> {
        match self.trouble.lock().ok().and_then(|mut trouble| trouble.take()) {
            Some(trouble) => Err(GpuError::Failed(trouble)),
            None => Ok(()),
        }
    }

    /// Most points that a buffer of 16 bytes each can hold.
    pub(super) fn most_points(&self) -> usize {
        let binding = self.device.limits().max_storage_buffer_binding_size.min(BINDING);
        (binding / 16) as usize
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
